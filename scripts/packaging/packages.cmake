# Manual pages, completions, Debian packages (scripts/package.sh) and the target `uninstall`.
set(packaging ${CMAKE_CURRENT_LIST_DIR})
include(GNUInstallDirs)
math(EXPR next_python "${Python_VERSION_MINOR} + 1")

if(RAILCAST_BUILD_IO AND NOT CMAKE_CROSSCOMPILING)
  set(manual_programs railcast-generate railcast-analyze)
  if(RAILCAST_BUILD_VIEWER)
    list(APPEND manual_programs railcast-view)
  endif()
  set(manual_files ${manual_programs})
  list(TRANSFORM manual_files REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  set(manuals ${PROJECT_BINARY_DIR}/manuals)
  get_property(extra_commands GLOBAL PROPERTY RAILCAST_EXTRA_COMMANDS)
  list(JOIN extra_commands "|" extra_pages)
  list(JOIN extra_commands , extra_commands)
  add_custom_command(
    OUTPUT ${manuals}/stamp
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${manuals}
    COMMAND ${Python_EXECUTABLE} ${packaging}/write_manuals.py ${manuals} --with=${extra_commands} ${manual_files}
    COMMAND ${CMAKE_COMMAND} -E touch ${manuals}/stamp
    DEPENDS ${manual_programs} ${packaging}/write_manuals.py ${packaging}/help_text.py
    COMMENT "Writing manual pages and completions")
  add_custom_target(railcast_manuals ALL DEPENDS ${manuals}/stamp)
  add_dependencies(installed railcast_manuals)

  # railcast_install_manuals(COMPONENT PROGRAM): all pages but those of extras' commands.
  function(railcast_install_manuals component program)
    install(DIRECTORY ${manuals}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT ${component}
            FILES_MATCHING PATTERN "${program}*" REGEX "${extra_pages}" EXCLUDE)
    install(FILES ${manuals}/bash/${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
            COMPONENT ${component})
    install(FILES ${manuals}/zsh/_${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
            COMPONENT ${component})
  endfunction()
  set(import_page railcast-generate-import.1.gz)
  set(extra_pages "-(${extra_pages})\\.1")
  railcast_install_manuals(programs railcast-generate)
  install(DIRECTORY ${manuals}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT extras
          FILES_MATCHING REGEX "${extra_pages}" PATTERN ${import_page} EXCLUDE)
  railcast_install_manuals(programs railcast-analyze)
  if(RAILCAST_BUILD_IMPORT)
    install(FILES ${manuals}/man1/${import_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT import)
  endif()
  if(RAILCAST_BUILD_VIEWER)
    railcast_install_manuals(viewer railcast-view)
  endif()
endif()

add_custom_target(
  uninstall
  COMMAND ${CMAKE_COMMAND} -D BUILD_DIR=${PROJECT_BINARY_DIR} -P ${packaging}/uninstall.cmake
  COMMENT "Removing what cmake --install has copied")

# What Debian wants in each package. Its 1.0.0~rc.1 comes before 1.0.0.
string(REPLACE "-" "~" package_version ${RAILCAST_VERSION})
set(RAILCAST_MAINTAINER
    "The railcast authors <railcast@example.org>"
    CACHE STRING "Who publishes the Debian packages")
execute_process(
  COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%aD
  OUTPUT_VARIABLE package_date
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT package_date)
  set(package_date "Thu, 01 Jan 1970 00:00:00 +0000")
endif()
set(documents ${PROJECT_BINARY_DIR}/package_documents)
configure_file(${packaging}/changelog.in ${documents}/changelog @ONLY)
execute_process(COMMAND gzip -9nf ${documents}/changelog COMMAND_ERROR_IS_FATAL ANY)

# railcast_document_package(PACKAGE COMPONENT)
function(railcast_document_package package component)
  install(FILES ${packaging}/copyright ${documents}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
  if(EXISTS ${packaging}/lintian/${package})
    install(FILES ${packaging}/lintian/${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
            COMPONENT ${component} EXCLUDE_FROM_ALL)
  endif()
endfunction()

# A unit for systemd, with the path of the packages.
install(FILES ${packaging}/railcast-stream@.service DESTINATION lib/systemd/system COMPONENT programs
        EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${package_version})
set(CPACK_PACKAGE_VENDOR "The railcast authors")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${RAILCAST_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENTS_ALL "")

# railcast_package(NAME SECTION "DESCRIPTION" DEPENDS ... RECOMMENDS ... PROVIDES ... COMPONENTS ...): the description's first line
# is its summary.
macro(railcast_package name section description)
  cmake_parse_arguments(ARG "" "" "DEPENDS;RECOMMENDS;SUGGESTS;PROVIDES;SCRIPTS;COMPONENTS" ${ARGN})
  string(TOUPPER ${name} group)
  set(CPACK_DEBIAN_${group}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${group}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${group}_DESCRIPTION "${description}")
  foreach(relation IN ITEMS DEPENDS RECOMMENDS SUGGESTS PROVIDES)
    list(JOIN ARG_${relation} ", " CPACK_DEBIAN_${group}_PACKAGE_${relation})
  endforeach()
  set(CPACK_DEBIAN_${group}_PACKAGE_CONTROL_EXTRA ${ARG_SCRIPTS})
  list(APPEND CPACK_COMPONENTS_ALL ${ARG_COMPONENTS})
  list(APPEND package_groups ${name})
  set(components_of_${name} ${ARG_COMPONENTS})
  list(GET ARG_COMPONENTS 0 first_component)
  railcast_document_package(${name} ${first_component})
endmacro()

if(RAILCAST_BUILD_IO)
  railcast_package(
    railcast science "LiDAR simulation for railways: programs
 Makes labelled point clouds of railway scenes from JSON scenarios: as files
 (PCD, PLY, KITTI), or live over UDP.
 railcast-generate makes frames; railcast-analyze measures and compares them."
    RECOMMENDS gnuplot-nox
    SUGGESTS railcast-all
    COMPONENTS programs)
endif()
get_property(extras GLOBAL PROPERTY RAILCAST_EXTRAS)
if(extras)
  # Whoever asks for one extra, as railcast-ros, gets the programs that have them all.
  list(TRANSFORM extras REPLACE "^[a-z]+/(.+)$" "railcast-\\1")
  list(REMOVE_DUPLICATES extras)
  list(REMOVE_ITEM extras railcast-import)
  list(TRANSFORM extras APPEND " (= ${package_version})" OUTPUT_VARIABLE provided)
  railcast_package(
    railcast-extras science "LiDAR simulation for railways: extras
 Adds to railcast: things put into recordings, conversion, replay, data sets,
 scenes from recordings, bags and topics of ROS 2, packets of real sensors,
 traces of OSI, studies with their dossiers, and evaluation of detectors."
    DEPENDS "railcast (= ${package_version})"
    PROVIDES ${provided}
    SUGGESTS weasyprint
    COMPONENTS extras)
endif()
if(RAILCAST_BUILD_IMPORT)
  railcast_package(
    railcast-import science "LiDAR simulation for railways: lines from maps
 Adds the command 'railcast-generate import', which fits the lines of maps
 (OpenStreetMap, railML, GeoJSON) and writes them as alignments of scenarios."
    DEPENDS "railcast (= ${package_version})"
    COMPONENTS import)
endif()
if(RAILCAST_BUILD_VIEWER)
  railcast_package(
    railcast-viewer science "LiDAR simulation for railways: viewer
 Shows point clouds of railcast and of others, recorded or live, with what is
 known of each point, and draws pictures and videos of them."
    COMPONENTS viewer)
endif()
if(RAILCAST_BUILD_PYTHON)
  railcast_package(
    python3-railcast python "LiDAR simulation for railways: Python module
 Simulated frames and recordings as NumPy arrays, and data sets for loaders of
 training programs."
    DEPENDS python3-numpy "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})"
            "python3 (<< ${Python_VERSION_MAJOR}.${next_python})"
    RECOMMENDS railcast  # Has the scenarios.
    SCRIPTS ${packaging}/python/postinst ${packaging}/python/prerm
    COMPONENTS python)
endif()
set(all_packages ${package_groups})
list(TRANSFORM all_packages APPEND " (= ${package_version})")
railcast_package(
  railcast-all metapackages "LiDAR simulation for railways: everything
 This metapackage brings the programs of railcast, all of their extras, the
 viewer and the Python module."
  DEPENDS ${all_packages}
  COMPONENTS everything)
set(assimp_package "")
if(RAILCAST_BUILD_ASSIMP)
  set(assimp_package libassimp-dev zlib1g-dev)  # The former names the latter's library.
endif()
railcast_package(
  railcast-dev libdevel "LiDAR simulation for railways: libraries
 Headers, libraries and CMake files of railcast's core for programs in C++, of
 its files and streams, and of its interface for programs in C."
  DEPENDS libeigen3-dev libembree-dev libopenmesh-dev libtbb-dev ${assimp_package}
  RECOMMENDS libpcl-dev libjpeg-dev liblz4-dev libpcap-dev libpng-dev libsqlite3-dev libssl-dev libxxhash-dev
             libyaml-cpp-dev libzstd-dev
  COMPONENTS core c io)

include(CPack)
foreach(name IN LISTS package_groups)
  cpack_add_component_group(${name})
  foreach(component IN LISTS components_of_${name})
    cpack_add_component(${component} GROUP ${name})
  endforeach()
endforeach()
