# Installs the build at BUILD_DIR below WORK_DIR as a whole, removes it as the target `uninstall` does, and finds neither
# files nor folders of railcast there.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR}/prefix/bin ${WORK_DIR}/build)
file(WRITE ${WORK_DIR}/prefix/bin/of_others "")
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix OUTPUT_QUIET
                        COMMAND_ERROR_IS_FATAL ANY)
# Other tests install from the same build at the same time.
file(RENAME ${BUILD_DIR}/install_manifest.txt ${WORK_DIR}/build/install_manifest.txt)
if(NOT EXISTS ${WORK_DIR}/prefix/bin/railcast-generate)
  message(FATAL_ERROR "railcast-generate was not installed")
endif()

function(uninstall)
  execute_process(COMMAND ${CMAKE_COMMAND} -D BUILD_DIR=${WORK_DIR}/build -P
                          ${SOURCE_DIR}/scripts/packaging/uninstall.cmake ERROR_VARIABLE said OUTPUT_VARIABLE said
                          RESULT_VARIABLE result)
  set(said "${said}" PARENT_SCOPE)
  set(result "${result}" PARENT_SCOPE)
endfunction()

uninstall()
file(GLOB_RECURSE files RELATIVE ${WORK_DIR}/prefix ${WORK_DIR}/prefix/*)
if(NOT result EQUAL 0 OR NOT files STREQUAL "bin/of_others")
  message(FATAL_ERROR "uninstall left ${files}: ${said}")
endif()
file(GLOB_RECURSE folders LIST_DIRECTORIES true ${WORK_DIR}/prefix/*)
list(FILTER folders INCLUDE REGEX railcast)
if(folders)
  message(FATAL_ERROR "uninstall left ${folders}")
endif()
uninstall()
if(result EQUAL 0 OR NOT said MATCHES "nothing was installed from it")
  message(FATAL_ERROR "uninstalling twice said: ${said}")
endif()
