# Links the Python module for all Linux systems with glibc 2.28 and later, whatever this one has:
# auditwheel's manylinux_2_28. METIS for them comes from PyPI; the file that calls it is compiled again,
# with its header.
set(manylinux_glibc 2.28)
set(manylinux_folder ${CMAKE_CURRENT_BINARY_DIR}/manylinux)
set(manylinux_metis ${manylinux_folder}/cmeel.prefix)
if(NOT EXISTS ${manylinux_metis}/lib/libmetis.so)
  execute_process(COMMAND ${Python_EXECUTABLE} -m pip download --quiet --disable-pip-version-check
                          --no-deps --only-binary :all: --platform manylinux_2_28_${CMAKE_SYSTEM_PROCESSOR}
                          --dest ${manylinux_folder} cmeel-metis==5.2.1.1 cmeel-gklib==0.0.1
                  COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB packages ${manylinux_folder}/cmeel_*.whl)
  foreach(package ${packages})
    file(ARCHIVE_EXTRACT INPUT ${package} DESTINATION ${manylinux_folder}
         PATTERNS cmeel.prefix/include/* cmeel.prefix/lib/*)
  endforeach()
endif()
set(runtime_list ${manylinux_folder}/runtime.txt)
if(NOT EXISTS ${runtime_list} OR ${CMAKE_CURRENT_LIST_DIR}/old_runtime.py IS_NEWER_THAN ${runtime_list})
  execute_process(COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/old_runtime.py ${manylinux_glibc}
                          ${CMAKE_CXX_COMPILER} ${manylinux_folder}
                  OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${runtime_list} "${text}")
endif()
file(READ ${runtime_list} manylinux_runtime)

set(metis_caller ${PROJECT_SOURCE_DIR}/src/solve/direct/ordering.cpp)
target_sources(littoral_python PRIVATE ${metis_caller})
set_property(SOURCE ${metis_caller} APPEND PROPERTY COMPILE_DEFINITIONS LITTORAL_METIS=1)
target_include_directories(littoral_python SYSTEM BEFORE PRIVATE ${manylinux_metis}/include)
target_link_options(littoral_python PRIVATE -nodefaultlibs)
# Both are named as needed, or the linker would take what METIS wants of GKlib from this system's METIS.
target_link_libraries(littoral_python PRIVATE -Wl,--push-state,--no-as-needed
  ${manylinux_metis}/lib/libmetis.so ${manylinux_metis}/lib/libGKlib.so -Wl,--pop-state)
