# Tests core/program/write_version.cmake on trees of its own: cmake -D SCRIPT=... -D FOLDER=... -P
# THIS_FILE.
cmake_minimum_required(VERSION 3.25)

find_program(GIT git REQUIRED)
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}/tree")

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${FOLDER}/tree" OUTPUT_QUIET
                  COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(expect_version pattern)
  run(${CMAKE_COMMAND} -D SOURCE_DIR=${FOLDER}/tree -D PROJECT_VERSION=0.1.0 -D
      OUTPUT=${FOLDER}/version.cpp -P ${SCRIPT})
  file(READ "${FOLDER}/version.cpp" text)
  if(NOT text MATCHES "return \"${pattern}\";")
    message(FATAL_ERROR "must say ${pattern} (got ${text})")
  endif()
endfunction()

# A tarball has no commit, even if it was unpacked within another repository.
run(${GIT} init --quiet "${FOLDER}")
expect_version("0\\.1\\.0")

run(${GIT} init --quiet)
file(WRITE "${FOLDER}/tree/a.cpp" "int a;\n")
run(${GIT} add a.cpp)
run(${GIT} -c user.name=a -c user.email=a@b commit --quiet -m a)
expect_version("0\\.1\\.0\\+[0-9a-f]+")

# The source keeps its time stamp, and is not compiled again, if nothing has changed.
file(TIMESTAMP "${FOLDER}/version.cpp" before "%s")
execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 1.1)
expect_version("0\\.1\\.0\\+[0-9a-f]+")
file(TIMESTAMP "${FOLDER}/version.cpp" after "%s")
if(NOT before STREQUAL after)
  message(FATAL_ERROR "the version was written anew though it is the same")
endif()

# Files that are not in the repository do not count as changes; edits of its files do.
file(WRITE "${FOLDER}/tree/notes.txt" "mine\n")
expect_version("0\\.1\\.0\\+[0-9a-f]+")
file(APPEND "${FOLDER}/tree/a.cpp" "int b;\n")
expect_version("0\\.1\\.0\\+[0-9a-f]+\\.dirty\\.[0-9a-f]+")
file(READ "${FOLDER}/version.cpp" first)
file(APPEND "${FOLDER}/tree/a.cpp" "int c;\n")
expect_version("0\\.1\\.0\\+[0-9a-f]+\\.dirty\\.[0-9a-f]+")
file(READ "${FOLDER}/version.cpp" second)
if(first STREQUAL second)
  message(FATAL_ERROR "two changes of one commit must have two versions")
endif()

# A repository that git cannot read.
file(WRITE "${FOLDER}/tree/.git/HEAD" "nothing")
expect_version("0\\.1\\.0\\+unknown")
