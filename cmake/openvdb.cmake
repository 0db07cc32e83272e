# OpenVDB (MPL 2), for .vdb: a module that the library loads when it is asked for one. Its own
# find module wants a dozen packages that this does not; what its headers need (boost, Imath) shows
# when they are compiled.
include(CheckCXXSourceCompiles)
find_path(OpenVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OpenVDB_LIBRARY openvdb)
find_library(TBB_LIBRARY tbb)
find_library(Imath_LIBRARY NAMES Imath-3_1 Imath Half)
mark_as_advanced(OpenVDB_INCLUDE_DIR OpenVDB_LIBRARY TBB_LIBRARY Imath_LIBRARY)
set(OpenVDB_LIBRARIES ${OpenVDB_LIBRARY} ${TBB_LIBRARY})
if(Imath_LIBRARY)
  list(APPEND OpenVDB_LIBRARIES ${Imath_LIBRARY})
endif()
if(OpenVDB_INCLUDE_DIR AND OpenVDB_LIBRARY AND TBB_LIBRARY)
  set(CMAKE_REQUIRED_INCLUDES ${OpenVDB_INCLUDE_DIR})
  set(CMAKE_REQUIRED_LIBRARIES ${OpenVDB_LIBRARIES})
  check_cxx_source_compiles("#include <openvdb/io/Stream.h>
    #include <openvdb/openvdb.h>
    #include <sstream>
    int main() {
      openvdb::initialize();
      openvdb::GridPtrVec grids{openvdb::FloatGrid::create(1)};
      std::ostringstream out;
      openvdb::io::Stream(out).write(grids);
    }" OpenVDB_LINKS)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
if(NOT OpenVDB_LINKS)
  message(STATUS "OpenVDB not found: littoral is built without .vdb")
  return()
endif()
add_library(littoral_vdb MODULE src/vdb/vdb_module.cpp)
# Symbols stay visible: OpenVDB's templates keep state that the library and its user must share.
set_target_properties(littoral_vdb PROPERTIES PREFIX "" SUFFIX ".so")
target_include_directories(littoral_vdb PRIVATE src include)
target_include_directories(littoral_vdb SYSTEM PRIVATE ${OpenVDB_INCLUDE_DIR})
target_link_libraries(littoral_vdb PRIVATE Eigen3::Eigen ${OpenVDB_LIBRARIES})
target_compile_definitions(littoral_vdb PRIVATE LITTORAL_VERSION="${PROJECT_VERSION}" EIGEN_MPL2_ONLY)
littoral_warnings(littoral_vdb)
target_compile_options(littoral_vdb PRIVATE $<$<CONFIG:Release>:-O1>)
install(TARGETS littoral_vdb LIBRARY DESTINATION ${littoral_modules_dir})
