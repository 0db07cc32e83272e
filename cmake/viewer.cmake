# The viewer page: installed dependencies (npm ci) and esbuild make one HTML file of viewer/src, which
# becomes a C++ source of the library. Everything is made in the build folder. littoral_studio_page()
# does the same with the page that the program serves for drawing.
function(littoral_studio_page target)
endfunction()
if(NOT LITTORAL_VIEWER)
  return()
endif()
find_program(LITTORAL_NODE NAMES node nodejs)
find_program(LITTORAL_NPM npm)
if(NOT LITTORAL_NODE OR NOT LITTORAL_NPM)
  message(STATUS "npm not found: littoral is built without the viewer page")
  return()
endif()

set(viewer_from ${CMAKE_CURRENT_SOURCE_DIR}/viewer)
set(viewer_to ${CMAKE_CURRENT_BINARY_DIR}/viewer)
file(GLOB viewer_sources CONFIGURE_DEPENDS ${viewer_from}/src/*)

add_custom_command(
  OUTPUT ${viewer_to}/installed.stamp
  COMMAND ${CMAKE_COMMAND} -E make_directory ${viewer_to}
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer_from}/package.json ${viewer_from}/package-lock.json
          ${viewer_to}
  COMMAND ${LITTORAL_NPM} ci --omit=dev --ignore-scripts --no-audit --no-fund --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${viewer_to}/installed.stamp
  DEPENDS ${viewer_from}/package.json ${viewer_from}/package-lock.json
  WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/viewer
  COMMENT "Fetching the viewer's packages"
  VERBATIM)
file(MAKE_DIRECTORY ${viewer_to})
add_custom_command(
  OUTPUT ${viewer_to}/page_template.cpp
  COMMAND ${LITTORAL_NODE} ${viewer_from}/build.mjs ${viewer_to} ${viewer_to}/node_modules
  DEPENDS ${viewer_to}/installed.stamp ${viewer_from}/build.mjs ${viewer_from}/bundle.mjs
          ${viewer_from}/literals.mjs
          ${CMAKE_CURRENT_SOURCE_DIR}/src/io/render/colour_maps.inc ${viewer_sources}
  COMMENT "Bundling the viewer page"
  VERBATIM)
target_sources(littoral PRIVATE ${viewer_to}/page_template.cpp)
set_source_files_properties(${viewer_to}/page_template.cpp PROPERTIES
  SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS -Wno-overlength-strings)
set_property(SOURCE src/io/page/page.cpp APPEND PROPERTY COMPILE_DEFINITIONS LITTORAL_HAS_VIEWER=1)

file(GLOB studio_sources CONFIGURE_DEPENDS web/studio/src/* web/src/*)
function(littoral_studio_page target)
  set(from ${CMAKE_SOURCE_DIR}/web/studio)
  set(to ${CMAKE_BINARY_DIR}/studio)
  add_custom_command(
    OUTPUT ${to}/studio_page.cpp
    COMMAND ${LITTORAL_NODE} ${from}/build.mjs ${to} native ${viewer_to}/node_modules
    DEPENDS ${viewer_to}/installed.stamp ${from}/build.mjs ${viewer_from}/bundle.mjs
            ${viewer_from}/literals.mjs ${studio_sources} ${viewer_sources}
            ${CMAKE_SOURCE_DIR}/src/io/render/colour_maps.inc
    COMMENT "Bundling the studio"
    VERBATIM)
  # A target of its own: the rest of the program need not wait for the library then, on which all
  # that is made for the program depends.
  add_library(littoral_studio OBJECT ${to}/studio_page.cpp)
  target_compile_features(littoral_studio PRIVATE cxx_std_20)
  target_include_directories(littoral_studio PRIVATE ${CMAKE_SOURCE_DIR}/src)
  littoral_warnings(littoral_studio)
  target_compile_options(littoral_studio PRIVATE -Wno-overlength-strings)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:littoral_studio>)
  set_property(SOURCE src/cli/studio.cpp APPEND PROPERTY COMPILE_DEFINITIONS LITTORAL_HAS_STUDIO=1)
endfunction()
