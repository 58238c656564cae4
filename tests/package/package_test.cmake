# Installs the core of the build at BUILD_DIR, as a host program would receive it, and builds and
# runs consumer/ against nothing but the installed files.
cmake_minimum_required(VERSION 3.25)

# Neither building nor using the core may ask for these.
set(without_extras)
foreach(extra IN ITEMS PCL VTK GTest benchmark)
  list(APPEND without_extras -D CMAKE_DISABLE_FIND_PACKAGE_${extra}=ON)
endforeach()
set(toolchain -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_CXX_FLAGS=${CXX_FLAGS})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(prefix ${WORK_DIR}/prefix)
file(REMOVE_RECURSE ${WORK_DIR})

# The core alone configures; its sources are the same in every configuration, so BUILD_DIR's serve.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/core_alone ${toolchain} ${without_extras}
    -D RAILCAST_BUILD_IO=OFF -D RAILCAST_BUILD_VIEWER=OFF -D RAILCAST_BUILD_TESTS=OFF)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component core)

# What is installed must work on a machine that has neither the sources nor the build.
file(GLOB_RECURSE package_files ${prefix}/*.cmake)
foreach(package_file IN LISTS package_files)
  file(STRINGS ${package_file} leaks REGEX "[\"; ](${SOURCE_DIR}|${BUILD_DIR})/")
  if(leaks)
    message(FATAL_ERROR "${package_file} names this build's folders: ${leaks}")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_DIR}/consumer ${toolchain}
    ${without_extras} -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/consumer)
run(${WORK_DIR}/consumer/consumer)
