# Finds the libraries that railcast::files and railcast::io are linked with. Both the build and the installed package
# include this file.
#
# PCL's own package file would also require VTK.
find_package(TBB REQUIRED)
find_package(JPEG REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
if(NOT RAILCAST_STAGE EQUAL 1)
  find_path(PCL_INCLUDE_DIR pcl/PCLPointCloud2.h PATH_SUFFIXES pcl-1.12 pcl-1.13 pcl-1.14 pcl-1.15 REQUIRED)
  find_library(PCL_common_LIBRARY pcl_common REQUIRED)
endif()
find_library(XXHASH_LIBRARY xxhash REQUIRED)
find_library(YAML_CPP_LIBRARY yaml-cpp REQUIRED)

# railcast_import(NAME LIBRARY [INCLUDE_DIR]): imports the library as the target railcast::NAME.
function(railcast_import name library)
  if(TARGET railcast::${name})
    return()
  endif()
  add_library(railcast::${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(railcast::${name} PROPERTIES IMPORTED_LOCATION ${library}
                                                     INTERFACE_INCLUDE_DIRECTORIES "${ARGN}")
endfunction()
if(PCL_INCLUDE_DIR AND NOT TARGET railcast::pcl_headers)
  add_library(railcast::pcl_headers INTERFACE IMPORTED GLOBAL)
  set_target_properties(railcast::pcl_headers PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${PCL_INCLUDE_DIR})
  # Only programs with a UdpGrabber load it. As one word, which CMake does not take apart.
  add_library(railcast::pcl_common INTERFACE IMPORTED GLOBAL)
  set_target_properties(
    railcast::pcl_common
    PROPERTIES INTERFACE_LINK_LIBRARIES
               "railcast::pcl_headers;-Wl,--push-state,--as-needed,${PCL_common_LIBRARY},--pop-state")
endif()
railcast_import(xxhash ${XXHASH_LIBRARY})
railcast_import(yaml_cpp ${YAML_CPP_LIBRARY})
