# What keeps a build short: -O2 but for the kernels, precompiled headers, and small files of one folder
# compiled together.
option(LITTORAL_UNITY "Compile the files of a folder together" ON)

# -O3 takes longer to compile and pays in few places, which are named below.
if(PROJECT_IS_TOP_LEVEL)
  string(REPLACE "-O3" "-O2" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
endif()
set(littoral_hot_sources
  src/io/render/openness.cpp
  src/methods/geodesic/exact_polyhedral.cpp src/methods/geodesic/fast_marching.cpp
  src/methods/geodesic/ray_crossing.cpp src/methods/geodesic/ray_kernels.cpp
  src/methods/heat/strip_cell_kernels.cpp src/methods/heat/yukawa_sum.cpp
  src/methods/tori/torus_kernels.cpp
  src/operators/sample_directions.cpp
  src/solve/direct/block_times.cpp src/solve/direct/dense_products.cpp
  src/solve/direct/supernode_kernels.cpp src/solve/direct/strip_kernels.cpp
  src/solve/multigrid/cosine_lines.cpp src/solve/multigrid/cosine_transform.cpp
  src/solve/network/flow_interior_point.cpp src/solve/network/network_simplex.cpp
  src/spatial/bound_kernels.cpp src/spatial/crossing_kernels.cpp src/spatial/crossing_number.cpp
  src/spatial/grid_distances.cpp src/spatial/nearest_kernels.cpp src/spatial/point_kernels.cpp
  src/spatial/triangle_bvh.cpp src/spatial/winding_kernels.cpp src/spatial/winding_number.cpp)
foreach(source ${littoral_hot_sources})
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${source})
    message(FATAL_ERROR "cmake/compile_times.cmake names ${source}, which is not there")
  endif()
endforeach()
if(NOT LITTORAL_QUICK_BUILD)  # files with options are compiled alone
  set_property(SOURCE ${littoral_hot_sources} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  # Beside a precompiled header of -O2 GCC does not do all that -O3 does; here it shows in the times.
  set_property(SOURCE src/solve/direct/block_times.cpp src/solve/direct/dense_products.cpp
    src/solve/direct/supernode_kernels.cpp src/solve/direct/strip_kernels.cpp src/spatial/crossing_number.cpp
    src/spatial/triangle_bvh.cpp src/spatial/winding_number.cpp
    PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endif()

# Eigen's decompositions of small matrices, as long to compile as a dozen other files.
set_property(SOURCE src/base/dense_decompositions.cpp APPEND PROPERTY COMPILE_OPTIONS -O1)
set_property(SOURCE src/base/dense_decompositions.cpp PROPERTY SKIP_PRECOMPILE_HEADERS ON)

# GCC collects garbage when a few hundred MB are in use, a tenth of its time; it needs not much more
# where it hardly does.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=1000000>)
endif()

# Compiles the files of each folder together, in portions of up to `bytes`; those with compile options
# of their own stay alone, as do the ones named after `bytes`. The folders of a room of
# `littoral_joined_rooms` count as one: what a library's headers instantiate is then compiled once in a
# portion, and not once in each small folder. Names in the unnamed namespaces of a folder, or of a
# joined room, must differ. Clang, which needs half the memory of GCC for it, compiles four times as
# many at a time: what they share is then compiled less often, which saves a quarter of the time for
# tests. GCC gains nothing from more.
set(littoral_joined_rooms cli io api sources domain operators contour solve methods)
function(littoral_compile_together target bytes)
  if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    math(EXPR bytes "4 * ${bytes}")
  endif()
  if(NOT LITTORAL_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(folder_before "")
  set(portion 0)
  set(size_so_far 0)
  foreach(source ${sources})
    get_property(options SOURCE ${source} PROPERTY COMPILE_OPTIONS)
    get_property(definitions SOURCE ${source} PROPERTY COMPILE_DEFINITIONS)
    if(options OR definitions OR source IN_LIST ARGN OR NOT source MATCHES "/(src|tests|fuzz/cases)/.*[.]cpp$")
      continue()
    endif()
    get_filename_component(folder ${source} DIRECTORY)
    if(source MATCHES "^${PROJECT_SOURCE_DIR}/src/([a-z]+)/" AND CMAKE_MATCH_1 IN_LIST littoral_joined_rooms)
      set(folder ${PROJECT_SOURCE_DIR}/src/${CMAKE_MATCH_1})
    endif()
    file(SIZE ${source} size)
    math(EXPR size_so_far "${size_so_far} + ${size}")
    if(NOT folder STREQUAL folder_before OR size_so_far GREATER bytes)
      math(EXPR portion "${portion} + 1")
      set(size_so_far ${size})
      set(folder_before ${folder})
    endif()
    string(REGEX REPLACE "^${PROJECT_SOURCE_DIR}/(src/)?" "" name ${folder})
    string(REPLACE "/" "_" name ${name})
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${name}_${portion})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
