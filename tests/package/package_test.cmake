# Installs the build at BUILD_DIR, as a host program would receive it, and builds and runs the
# programs of docs/engine.md and docs/embedding.md against the installed files only: first those in C
# and Python with only the C interface installed, then those of the core with the core beside it,
# then, if WITH_IO, those of the clouds with all three.
cmake_minimum_required(VERSION 3.25)

# Neither building nor using the core may require these packages.
set(without_extras)
foreach(extra IN ITEMS PCL VTK GTest benchmark JPEG PNG)
  list(APPEND without_extras -D CMAKE_DISABLE_FIND_PACKAGE_${extra}=ON)
endforeach()
set(toolchain -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_CXX_FLAGS=${CXX_FLAGS})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(prefix ${WORK_DIR}/prefix)
set(programs ${WORK_DIR}/programs)
file(REMOVE_RECURSE ${WORK_DIR})

# write_programs(PAGE LANGUAGE COMMENT): writes each block in LANGUAGE of docs/PAGE to the file that
# its first line names, in a comment that begins with COMMENT.
function(write_programs page language comment)
  file(READ ${SOURCE_DIR}/docs/${page} rest)
  # CMake would parse these characters as parts of its own lists.
  string(REPLACE ";" "<semicolon>" rest "${rest}")
  string(REPLACE "[" "<bracket>" rest "${rest}")
  string(REPLACE "]" "<closing bracket>" rest "${rest}")
  string(REGEX MATCHALL "```${language}\n${comment} [a-z]+\\.[a-z]+: [^`]*```" blocks "${rest}")
  string(REGEX MATCHALL "```${language}\n" all_blocks "${rest}")
  list(LENGTH blocks num_programs)
  list(LENGTH all_blocks num_blocks)
  if(NOT num_programs EQUAL num_blocks OR num_programs EQUAL 0)
    message(FATAL_ERROR "${page}: a block of ${language} does not begin with \"${comment} NAME: \" or "
                        "holds a backtick")
  endif()
  foreach(block IN LISTS blocks)
    string(REGEX MATCH "${comment} ([a-z]+\\.[a-z]+): " unused "${block}")
    set(name ${CMAKE_MATCH_1})
    string(REGEX REPLACE "^```${language}\n|```$" "" block "${block}")
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

# build_programs(BUILD OPTION...): builds the consumer in BUILD.
function(build_programs build)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${build} ${toolchain} ${ARGN}
      -D CMAKE_PREFIX_PATH=${prefix} -D PROGRAMS_DIR=${programs})
  run(${CMAKE_COMMAND} --build ${build})
endfunction()

function(build_and_run_core_programs build)
  build_programs(${build} ${without_extras})
  execute_process(COMMAND ${build}/frames ${SOURCE_DIR}/scenarios/minimal.json
                  OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  if(frames_of_python AND NOT frames_of_python STREQUAL said)
    message(FATAL_ERROR "frames.py: ${frames_of_python}frames.cpp: ${said}")
  endif()
  run(${build}/wall)
  run(${build}/caster)
endfunction()

# build_and_run_c_programs(): leaves in ${frames_of_python} what the Python program says.
function(build_and_run_c_programs)
  set(build ${WORK_DIR}/c_programs)
  # The Eigen, Embree, TBB and OpenMesh that built the library are no concern of its users.
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/c_consumer -B ${build} -G ${GENERATOR}
      -D CMAKE_C_COMPILER=${C_COMPILER} -D CMAKE_C_FLAGS=${CXX_FLAGS} ${without_extras}
      -D CMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON -D CMAKE_DISABLE_FIND_PACKAGE_embree=ON
      -D CMAKE_DISABLE_FIND_PACKAGE_TBB=ON -D CMAKE_DISABLE_FIND_PACKAGE_OpenMesh=ON
      -D CMAKE_PREFIX_PATH=${prefix} -D PROGRAMS_DIR=${programs})
  run(${CMAKE_COMMAND} --build ${build})
  run(${build}/scene ${SOURCE_DIR}/scenarios)
  run(${build}/axes)
  run(${build}/actor ${SOURCE_DIR}/scenarios)
  if(CXX_FLAGS MATCHES "-fsanitize")
    message("frames.py is left out: python3 was not built with the sanitizer")
    return()
  endif()
  file(GLOB_RECURSE library ${prefix}/*/librailcast.so)
  execute_process(
    COMMAND python3 ${programs}/frames.py ${library} ${SOURCE_DIR}/scenarios/minimal.json
    OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  set(frames_of_python "${said}" PARENT_SCOPE)
endfunction()

write_programs(embedding.md cpp //)
write_programs(engine.md c //)
write_programs(engine.md python "#")

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component c)
check_for_leaks()
build_and_run_c_programs()

# The core can be configured alone. Its sources are the same in every configuration, so the build at
# BUILD_DIR is installed.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/core_alone ${toolchain} ${without_extras}
    -D RAILCAST_BUILD_IO=OFF -D RAILCAST_BUILD_VIEWER=OFF -D RAILCAST_BUILD_TESTS=OFF)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component core)
check_for_leaks()
build_and_run_core_programs(${WORK_DIR}/core_programs)

if(WITH_IO)
  run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component io)
  check_for_leaks()
  set(build ${WORK_DIR}/io_programs)
  build_programs(${build} -D WITH_IO=ON)
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
