# OpenVDB (MPL 2), for writing .vdb. Its own find module wants a dozen packages that this does not; what
# its headers need (boost, Imath) shows when they are compiled.
include(CheckCXXSourceCompiles)
find_path(OpenVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OpenVDB_LIBRARY openvdb)
find_library(TBB_LIBRARY tbb)
find_library(Imath_LIBRARY NAMES Imath-3_1 Imath)
mark_as_advanced(OpenVDB_INCLUDE_DIR OpenVDB_LIBRARY TBB_LIBRARY Imath_LIBRARY)
if(OpenVDB_INCLUDE_DIR AND OpenVDB_LIBRARY AND TBB_LIBRARY AND Imath_LIBRARY)
  set(CMAKE_REQUIRED_INCLUDES ${OpenVDB_INCLUDE_DIR})
  set(CMAKE_REQUIRED_LIBRARIES ${OpenVDB_LIBRARY} ${TBB_LIBRARY} ${Imath_LIBRARY})
  check_cxx_source_compiles("#include <openvdb/openvdb.h>
    int main() { openvdb::initialize(); }" OpenVDB_WORKS)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
if(NOT OpenVDB_WORKS)
  message(STATUS "OpenVDB not found: littoral is built without .vdb")
  return()
endif()
target_include_directories(littoral SYSTEM PRIVATE ${OpenVDB_INCLUDE_DIR})
target_link_libraries(littoral PRIVATE ${OpenVDB_LIBRARY} ${TBB_LIBRARY} ${Imath_LIBRARY})
set_source_files_properties(src/littoral/io/volume_vdb.cpp PROPERTIES
  SKIP_PRECOMPILE_HEADERS ON COMPILE_DEFINITIONS LITTORAL_OPENVDB=1)
