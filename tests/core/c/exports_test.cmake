# Compares the symbols that LIBRARY exports with the functions that HEADER declares.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${NM} -D --defined-only ${LIBRARY} OUTPUT_VARIABLE symbols
                                                           COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^ \n]+\n" exported "${symbols}")
file(READ ${HEADER} header)
string(REGEX REPLACE "//[^\n]*" "" header "${header}")
string(REGEX MATCHALL "(railcast_status|const char\\*|int|void) railcast_[a-z_]+\\(" functions
                      "${header}")
list(TRANSFORM exported STRIP)
list(TRANSFORM functions REPLACE "^.* |\\($" "")
list(SORT exported)
list(SORT functions)
if(NOT exported STREQUAL functions)
  message(FATAL_ERROR "exported: ${exported}\ndeclared: ${functions}")
endif()
