# Extras are what can be taken away: folders below core/extras, generator/extras and analysis/extras, which the product knows
# only as far as they are there.

# railcast_extra([USES FOLDER...] [NEEDS PACKAGE...] [ADDS TYPE...] [COMMANDS NAME...] [UNIT NAME] SOURCES SOURCE...
# [LIBS LIBRARY...]): what the CMakeLists.txt of an extra's folder begins with. Its name is the folder's, its option
# RAILCAST_BUILD_NAME, on by default where the packages are there that it needs. What follows in the file is left out where
# the option is off, or where an extra that it uses is not built.
#
# USES names folders of other extras without the word extras: core/ros. NEEDS names packages for find_package(). ADDS
# names the types of registries (railcast_gather_extras()) that the extra fills by a function AddNAME, COMMANDS the
# commands of the programs that it adds. The library is
# railcast_NAME, or railcast_generate_NAME and railcast_analyze_NAME below generator and analysis. In a unity build, extras
# that name the same UNIT are one library, to which their names lead: a few hundred lines alone would be parsed with as
# many headers as thousands. What follows in the file calls the library ${extra_target}.
macro(railcast_extra)
  cmake_parse_arguments(EXTRA "" "UNIT" "USES;NEEDS;ADDS;COMMANDS;SOURCES;LIBS" ${ARGN})
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE extra_folder)
  string(REPLACE "/extras/" "/" extra_folder ${extra_folder})
  railcast_name_extra(${extra_folder} extra_target)
  cmake_path(GET extra_folder FILENAME extra_name)
  string(TOUPPER RAILCAST_BUILD_${extra_name} extra_option)
  foreach(used IN LISTS EXTRA_USES)
    railcast_add_extra(${used})
    railcast_name_extra(${used} used_target)
    if(NOT TARGET ${used_target})
      message(STATUS "Without ${extra_folder}, which uses ${used}")
      return()
    endif()
    # No library is linked to itself.
    get_target_property(used_unit ${used_target} ALIASED_TARGET)
    if(NOT used_unit OR NOT used_unit STREQUAL "railcast_unit_${EXTRA_UNIT}")
      list(APPEND EXTRA_LIBS ${used_target})
    endif()
  endforeach()
  set(extra_has_packages ON)
  foreach(needed IN LISTS EXTRA_NEEDS)
    find_package(${needed} QUIET)
    if(NOT ${needed}_FOUND)
      set(extra_has_packages OFF)
    endif()
  endforeach()
  option(${extra_option} "Build the extra ${extra_name}" ${extra_has_packages})
  if(NOT ${extra_option})
    return()
  endif()
  if(NOT extra_has_packages)
    message(FATAL_ERROR "${extra_option} is ON, but one of its packages is not there: ${EXTRA_NEEDS}")
  endif()
  if(EXTRA_UNIT AND CMAKE_UNITY_BUILD)
    set(extra_unit railcast_unit_${EXTRA_UNIT})
    if(NOT TARGET ${extra_unit})
      add_library(${extra_unit} STATIC)
      target_precompile_headers(${extra_unit} REUSE_FROM railcast_core)
    endif()
    add_library(${extra_target} ALIAS ${extra_unit})
    set(extra_target ${extra_unit})
  else()
    add_library(${extra_target} STATIC)
    target_precompile_headers(${extra_target} REUSE_FROM railcast_core)
  endif()
  list(TRANSFORM EXTRA_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  target_sources(${extra_target} PRIVATE ${EXTRA_SOURCES})
  target_link_libraries(${extra_target} PUBLIC ${EXTRA_LIBS} PRIVATE $<BUILD_INTERFACE:railcast_internal>)
  foreach(type IN LISTS EXTRA_ADDS)
    set_property(GLOBAL APPEND PROPERTY RAILCAST_${type} ${extra_name})
    set_property(GLOBAL APPEND PROPERTY RAILCAST_${type}_LIBRARIES ${extra_target})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY RAILCAST_EXTRAS ${extra_folder})
  set_property(GLOBAL APPEND PROPERTY RAILCAST_EXTRA_COMMANDS ${EXTRA_COMMANDS})
  set_property(GLOBAL PROPERTY RAILCAST_USED_BY_${extra_folder} ${EXTRA_USES})
endmacro()

# railcast_install_extra(): installs the library of an extra below core with railcast::io, and the dependencies.cmake of its
# folder, which finds what it is linked with; includes the latter.
macro(railcast_install_extra)
  include(dependencies.cmake)
  install(FILES dependencies.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/railcast/extras RENAME ${extra_name}.cmake
          COMPONENT io)
  install(TARGETS ${extra_target} EXPORT railcast-io-targets ARCHIVE COMPONENT io)
endmacro()

# railcast_name_extra(FOLDER RESULT): the library of an extra, "core/ros".
function(railcast_name_extra folder result)
  string(REGEX REPLACE "^core/" "railcast_" name ${folder})
  string(REGEX REPLACE "^generator/" "railcast_generate_" name ${name})
  string(REGEX REPLACE "^analysis/" "railcast_analyze_" name ${name})
  set(${result} ${name} PARENT_SCOPE)
endfunction()

# railcast_add_extra(FOLDER): adds the extra's directory, if it is there and was not added yet.
function(railcast_add_extra folder)
  string(REPLACE "/" "/extras/" directory ${folder})
  get_property(is_added GLOBAL PROPERTY RAILCAST_ADDED_${folder})
  if(is_added OR NOT EXISTS ${PROJECT_SOURCE_DIR}/${directory}/CMakeLists.txt)
    return()
  endif()
  set_property(GLOBAL PROPERTY RAILCAST_ADDED_${folder} ON)
  add_subdirectory(${PROJECT_SOURCE_DIR}/${directory} ${PROJECT_BINARY_DIR}/${directory})
endfunction()

# railcast_add_extras(FOLDER): adds all of a top-level folder.
function(railcast_add_extras folder)
  file(GLOB extras RELATIVE ${PROJECT_SOURCE_DIR}/${folder}/extras CONFIGURE_DEPENDS
       ${PROJECT_SOURCE_DIR}/${folder}/extras/*/CMakeLists.txt)
  foreach(extra IN LISTS extras)
    cmake_path(GET extra PARENT_PATH extra)
    railcast_add_extra(${folder}/${extra})
  endforeach()
  # The program that extras of a folder share.
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder}/extras/CMakeLists.txt)
    add_subdirectory(${folder}/extras)
  endif()
endfunction()

# railcast_define_registry(SOURCE HEADER TYPE [EXTRA...]): writes SOURCE, which defines `const TYPE& TYPE::Get()` of HEADER. What
# it returns is filled by the functions AddEXTRA(TYPE&), so that the product needs to know no extra.
function(railcast_define_registry source header type)
  set(declared "")
  set(called "")
  foreach(extra IN LISTS ARGN)
    string(SUBSTRING ${extra} 0 1 first)
    string(SUBSTRING ${extra} 1 -1 rest)
    string(TOUPPER ${first} first)
    string(APPEND declared "void Add${first}${rest}(${type}& extras);\n")
    string(APPEND called "    Add${first}${rest}(extras);\n")
  endforeach()
  file(CONFIGURE OUTPUT ${source} CONTENT [[
// Written by CMake: what the extras of this build add.
#include "@header@"

namespace railcast {

@declared@
const @type@& @type@::Get() {
  static const @type@ all = [] {
    @type@ extras;
@called@    return extras;
  }();
  return all;
}

}  // namespace railcast
]] @ONLY)
endfunction()

# railcast_gather_extras(LIBRARY HEADER TYPE): the library that defines the registry TYPE of HEADER, with all extras that add to
# it. To be called once these are known. What links it and what it links may form a cycle, as static libraries may.
function(railcast_gather_extras library header type)
  get_property(extras GLOBAL PROPERTY RAILCAST_${type})
  get_property(libraries GLOBAL PROPERTY RAILCAST_${type}_LIBRARIES)
  set(source ${PROJECT_BINARY_DIR}/registries/${library}.cpp)
  railcast_define_registry(${source} ${header} ${type} ${extras})
  add_library(${library} STATIC ${source})
  target_precompile_headers(${library} REUSE_FROM railcast_core)
  target_link_libraries(${library} PRIVATE railcast::core $<BUILD_INTERFACE:railcast_internal> ${libraries})
endfunction()

# railcast_leave_out_extras(TARGET [HEADER TYPE]...): gives a program registries in which there is nothing, whatever extras the
# build has: its own definitions of TYPE::Get() come before those of the libraries.
function(railcast_leave_out_extras target)
  set(registries ${ARGN})
  while(registries)
    list(POP_FRONT registries header type)
    set(source ${PROJECT_BINARY_DIR}/registries/${target}_${type}.cpp)
    railcast_define_registry(${source} ${header} ${type})
    target_sources(${target} PRIVATE ${source})
  endwhile()
endfunction()

# railcast_install_program(TARGET [HEADER TYPE]...): installs a program of the product. Where the build has extras, there are two
# of it: the target, in libexec for the component extras, and one in whose registries (railcast_gather_extras()) there is
# nothing, which runs the former where it is installed (ProgramMain()).
function(railcast_install_program target)
  get_property(extras GLOBAL PROPERTY RAILCAST_EXTRAS)
  if(NOT extras)
    install(TARGETS ${target} COMPONENT programs)
    return()
  endif()
  install(TARGETS ${target} DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/railcast COMPONENT extras)
  set(product ${target}-product)
  add_executable(${product} $<TARGET_OBJECTS:${target}>)
  railcast_leave_out_extras(${product} ${ARGN})
  target_precompile_headers(${product} REUSE_FROM railcast_core)
  get_target_property(libraries ${target} LINK_LIBRARIES)
  target_link_libraries(${product} PRIVATE ${libraries})
  # Libraries of extras are on the line, too, but nothing is taken of them.
  target_link_options(${product} PRIVATE -Wl,--as-needed)
  set_target_properties(${product} PROPERTIES OUTPUT_NAME ${target} RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/product)
  install(TARGETS ${product} COMPONENT programs)
endfunction()

# railcast_list_libraries(FILE LIBRARY...): writes as JSON which files the product's libraries are, and for each extra its file and
# what it uses: what tests/lint/link_alone_test.py reads.
function(railcast_list_libraries file)
  set(product "")
  foreach(library IN LISTS ARGN)
    if(TARGET ${library})
      list(APPEND product "\"$<TARGET_FILE:${library}>\"")
    endif()
  endforeach()
  list(JOIN product ", " product)
  set(extras "")
  get_property(folders GLOBAL PROPERTY RAILCAST_EXTRAS)
  foreach(folder IN LISTS folders)
    railcast_name_extra(${folder} library)
    get_property(used GLOBAL PROPERTY RAILCAST_USED_BY_${folder})
    list(TRANSFORM used REPLACE "(.+)" "\"\\1\"")
    list(JOIN used ", " used)
    list(APPEND extras "\"${folder}\": {\"file\": \"$<TARGET_FILE:${library}>\", \"uses\": [${used}]}")
  endforeach()
  list(JOIN extras ",\n  " extras)
  file(GENERATE OUTPUT ${file} CONTENT "{\"product\": [${product}],\n \"extras\": {\n  ${extras}}}\n")
endfunction()
