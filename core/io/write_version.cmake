# Writes OUTPUT, the source that knows the version, anew if the commit has changed. To be run by every
# build: cmake -D SOURCE_DIR=... -D PROJECT_VERSION=... -D OUTPUT=... -P write_version.cmake
set(version "${PROJECT_VERSION}")

# A repository around an unpacked tarball is none of ours.
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
    # For example because the tree belongs to somebody else.
    string(APPEND version "+unknown")
  endif()
endif()

# Leaves the file alone where it says so already.
configure_file("${CMAKE_CURRENT_LIST_DIR}/version.cpp.in" "${OUTPUT}" @ONLY)
