# Installs the build at BUILD_DIR, as a host program would receive it, and builds and runs the
# programs of docs/embedding.md against the installed files only: first those of the core with only
# the core installed, then, if WITH_IO, all of them.
cmake_minimum_required(VERSION 3.25)

# Neither building nor using the core may require these packages.
set(without_extras)
foreach(extra IN ITEMS PCL VTK GTest benchmark)
  list(APPEND without_extras -D CMAKE_DISABLE_FIND_PACKAGE_${extra}=ON)
endforeach()
set(toolchain -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_CXX_FLAGS=${CXX_FLAGS})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(prefix ${WORK_DIR}/prefix)
set(programs ${WORK_DIR}/programs)
file(REMOVE_RECURSE ${WORK_DIR})

# write_programs(): writes each C++ block of the page to the file that its first line names.
function(write_programs)
  file(READ ${SOURCE_DIR}/docs/embedding.md rest)
  # CMake would parse these characters as parts of its own lists.
  string(REPLACE ";" "<semicolon>" rest "${rest}")
  string(REPLACE "[" "<bracket>" rest "${rest}")
  string(REPLACE "]" "<closing bracket>" rest "${rest}")
  string(REGEX MATCHALL "```cpp\n// [a-z]+\\.cpp: [^`]*```" blocks "${rest}")
  string(REGEX MATCHALL "```cpp" all_blocks "${rest}")
  list(LENGTH blocks num_programs)
  list(LENGTH all_blocks num_blocks)
  if(NOT num_programs EQUAL num_blocks)
    message(FATAL_ERROR "a C++ block does not begin with \"// NAME.cpp: \" or holds a backtick")
  endif()
  foreach(block IN LISTS blocks)
    string(REGEX MATCH "// ([a-z]+\\.cpp): " unused "${block}")
    set(name ${CMAKE_MATCH_1})
    string(REGEX REPLACE "^```cpp\n|```$" "" block "${block}")
    string(REPLACE "<semicolon>" ";" block "${block}")
    string(REPLACE "<bracket>" "[" block "${block}")
    string(REPLACE "<closing bracket>" "]" block "${block}")
    file(WRITE ${programs}/${name} "${block}")
  endforeach()
endfunction()

# The installed package must work on a machine that has neither the sources nor the build.
function(check_for_leaks)
  file(GLOB_RECURSE package_files ${prefix}/*.cmake)
  foreach(package_file IN LISTS package_files)
    file(STRINGS ${package_file} leaks REGEX "[\"; ](${SOURCE_DIR}|${BUILD_DIR})/")
    if(leaks)
      message(FATAL_ERROR "${package_file} names this build's folders: ${leaks}")
    endif()
  endforeach()
  # A host program may have a frame/frame.h of its own, so all headers of railcast are in railcast/.
  file(GLOB strangers RELATIVE ${prefix}/include ${prefix}/include/*)
  if(NOT strangers STREQUAL "railcast")
    message(FATAL_ERROR "include/ holds more than railcast/: ${strangers}")
  endif()
endfunction()

function(build_and_run_core_programs build)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${build} ${toolchain} ${ARGN}
      -D CMAKE_PREFIX_PATH=${prefix} -D PROGRAMS_DIR=${programs})
  run(${CMAKE_COMMAND} --build ${build})
  run(${build}/frames ${SOURCE_DIR}/scenarios/minimal.json)
  run(${build}/wall)
  run(${build}/caster)
endfunction()

write_programs()

# The core can be configured alone. Its sources are the same in every configuration, so the build at
# BUILD_DIR is installed.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/core_alone ${toolchain} ${without_extras}
    -D RAILCAST_BUILD_IO=OFF -D RAILCAST_BUILD_VIEWER=OFF -D RAILCAST_BUILD_TESTS=OFF)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component core)
check_for_leaks()
build_and_run_core_programs(${WORK_DIR}/core_programs ${without_extras})

if(WITH_IO)
  run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component io)
  check_for_leaks()
  set(build ${WORK_DIR}/io_programs)
  build_and_run_core_programs(${build} -D WITH_IO=ON)
  run(${build}/files ${SOURCE_DIR}/scenarios/minimal.json ${WORK_DIR}/frame.pcd)
  # The commands of one call run at the same time.
  execute_process(
    COMMAND ${BUILD_DIR}/generator/railcast-generate stream ${SOURCE_DIR}/scenarios/minimal.json
            --to 127.0.0.1:27499 --duration 3
    COMMAND ${build}/grab 127.0.0.1:27499
    OUTPUT_VARIABLE said RESULTS_VARIABLE results)
  list(GET results 1 grabbed)
  if(NOT grabbed EQUAL 0)
    message(FATAL_ERROR "grab: ${grabbed} (${said})")
  endif()
endif()
