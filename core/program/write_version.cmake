# Rewrites OUTPUT, the source that contains the version, if the commit has changed. Every build runs
# it: cmake -D SOURCE_DIR=... -D PROJECT_VERSION=... -D OUTPUT=... -P write_version.cmake
set(version "${PROJECT_VERSION}")

# A .git above SOURCE_DIR, around an unpacked tarball, is not the project's repository.
find_program(GIT git)
if(GIT AND EXISTS "${SOURCE_DIR}/.git")
  execute_process(
    COMMAND "${GIT}" rev-parse --short=12 HEAD
    WORKING_DIRECTORY "${SOURCE_DIR}"
    OUTPUT_VARIABLE commit
    RESULT_VARIABLE status
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(status EQUAL 0)
    string(APPEND version "+${commit}")
    execute_process(
      COMMAND "${GIT}" --no-optional-locks diff HEAD
      WORKING_DIRECTORY "${SOURCE_DIR}"
      OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT changes STREQUAL "")
      string(SHA256 hash "${changes}")
      string(SUBSTRING "${hash}" 0 8 hash)
      string(APPEND version ".dirty.${hash}")
    endif()
  else()
    # git fails, for example, if the tree belongs to another user.
    string(APPEND version "+unknown")
  endif()
endif()

# configure_file() leaves the file alone if its content would not change.
configure_file("${CMAKE_CURRENT_LIST_DIR}/version.cpp.in" "${OUTPUT}" @ONLY)
