# Installs the build at BUILD_DIR, as a host program would receive it, and builds and runs examples/
# against the installed files only: first the programs in C, and the one in Python that needs no more,
# with only the C interface installed, then those of the core with the core beside it, then, if
# WITH_IO, those of the clouds with all three. The programs in Python that need the module are run by
# tests/python/examples_test.py.
cmake_minimum_required(VERSION 3.25)

# Neither building nor using the core may require these packages.
set(extras PCL VTK GTest benchmark JPEG PNG)
# The libraries that built the C interface are no concern of its users.
set(libraries_of_core Eigen3 embree TBB OpenMesh assimp)
set(toolchain -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_CXX_FLAGS=${CXX_FLAGS})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# run_for(OUTPUT COMMAND...): runs the command and keeps what it prints.
function(run_for output)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
  set(${output} "${said}" PARENT_SCOPE)
endfunction()

# run_beside(SCENARIO EXAMPLE PORT): runs an example that receives a stream, which ends with it, and sets `said` and
# `status` to what it prints and to its exit status.
function(run_beside scenario example port)
  execute_process(
    COMMAND sh -c "\"$1\" stream \"$2\" --to $4 --duration 100 >/dev/null & timeout 60 \"$3\" $4; status=$?; kill $!; exit $status" sh
            ${BUILD_DIR}/generator/railcast-generate ${scenario} ${examples}/${example} 127.0.0.1:${port}
    OUTPUT_VARIABLE said RESULT_VARIABLE status TIMEOUT 120)
  return(PROPAGATE said status)
endfunction()

set(prefix ${WORK_DIR}/prefix)
set(examples ${WORK_DIR}/examples)
set(minimal ${SOURCE_DIR}/scenarios/minimal.json)
file(REMOVE_RECURSE ${WORK_DIR})

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

# without(VARIABLE VALUE PACKAGE...): the options that hide packages (VALUE ON) or show them again.
function(without variable value)
  set(options ${ARGN})
  list(TRANSFORM options REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=${value}")
  set(${variable} ${options} PARENT_SCOPE)
endfunction()

# install_and_build(COMPONENT OPTION...): builds the examples that the component adds.
function(install_and_build component)
  run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} --component ${component})
  check_for_leaks()
  run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/examples -B ${examples} ${toolchain} -D CMAKE_C_COMPILER=${C_COMPILER}
      "-DCMAKE_C_FLAGS=${CXX_FLAGS} -pedantic -Wall -Wextra -Werror" -D CMAKE_PREFIX_PATH=${prefix} ${ARGN})
  run(${CMAKE_COMMAND} --build ${examples})
endfunction()

without(nothing_but_c ON ${extras} ${libraries_of_core})
install_and_build(c ${nothing_but_c})
run_for(frames_of_c ${examples}/simulate_frame_c ${minimal})
run(${examples}/host_scene_c ${SOURCE_DIR}/scenarios)
run(${examples}/engine_axes_c)
run(${examples}/engine_actor_c ${SOURCE_DIR}/scenarios)
if(CXX_FLAGS MATCHES "-fsanitize")
  message("simulate_frame_ctypes.py is left out: python3 was not built with the sanitizer")
else()
  file(GLOB_RECURSE library ${prefix}/*/librailcast.so)
  run_for(frames_of_python python3 ${SOURCE_DIR}/examples/simulate_frame_ctypes.py ${library} ${minimal})
  if(NOT frames_of_python STREQUAL frames_of_c)
    message(FATAL_ERROR "Python: ${frames_of_python}C: ${frames_of_c}")
  endif()
endif()

# The core can be configured alone. Its sources are the same in every configuration, so the build at
# BUILD_DIR is installed.
without(no_extras ON ${extras})
without(with_core OFF ${libraries_of_core})
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/core_alone ${toolchain} ${no_extras}
    -D RAILCAST_BUILD_IO=OFF -D RAILCAST_BUILD_VIEWER=OFF -D RAILCAST_BUILD_TESTS=OFF)
install_and_build(core ${with_core})
run_for(frames_of_cpp ${examples}/simulate_frame_cpp ${minimal})
if(NOT frames_of_cpp STREQUAL frames_of_c)
  message(FATAL_ERROR "C++: ${frames_of_cpp}C: ${frames_of_c}")
endif()
run(${examples}/own_world_cpp)
run(${examples}/own_ray_caster_cpp)
run(${examples}/own_effect_cpp ${minimal})

if(WITH_IO)
  without(with_extras OFF ${extras})
  install_and_build(io ${with_extras})
  run(${examples}/write_cloud_cpp ${minimal} ${WORK_DIR}/frame.pcd)
  run_for(said ${examples}/read_recording_cpp ${WORK_DIR}/frame.pcd)
  if(NOT said MATCHES "frame.pcd: [1-9][0-9]* points in [0-9]+ rows, with labels")
    message(FATAL_ERROR "read_recording: ${said}")
  endif()
  # The same pipeline of PCL on a frame, on the file of it, and on a stream.
  set(approach ${SOURCE_DIR}/scenarios/st_gallen_approach.json)
  run(${BUILD_DIR}/generator/railcast-generate sequence ${approach} --frames 1 --out ${WORK_DIR}/sequence)
  run_for(in_frame ${examples}/find_things_cpp ${approach})
  run_for(in_file ${examples}/find_things_cpp ${WORK_DIR}/sequence/frames/000000.pcd)
  if(NOT in_frame STREQUAL in_file OR NOT in_frame MATCHES "cells of label [1-9][0-9]* in a box of")
    message(FATAL_ERROR "find_things: ${in_frame} in the frame, ${in_file} in its file")
  endif()
  run_beside(${approach} find_things_cpp 27498)
  if(NOT status EQUAL 0 OR NOT said MATCHES "cells of label [1-9][0-9]* in a box of")
    message(FATAL_ERROR "find_things in a stream: ${status} (${said})")
  endif()
  run_beside(${minimal} receive_stream_cpp 27499)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "receive_stream: ${status} (${said})")
  endif()
endif()
