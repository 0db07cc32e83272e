# Links the Python module for all Linux systems with glibc 2.28 and later, whatever this one has:
# auditwheel's manylinux_2_28.
set(manylinux_glibc 2.28)
set(manylinux_folder ${CMAKE_CURRENT_BINARY_DIR}/manylinux)
file(MAKE_DIRECTORY ${manylinux_folder})
set(runtime_list ${manylinux_folder}/runtime.txt)
if(NOT EXISTS ${runtime_list} OR ${CMAKE_CURRENT_LIST_DIR}/old_runtime.py IS_NEWER_THAN ${runtime_list})
  execute_process(COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/old_runtime.py ${manylinux_glibc}
                          ${CMAKE_CXX_COMPILER} ${manylinux_folder}
                  OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${runtime_list} "${text}")
endif()
file(READ ${runtime_list} manylinux_runtime)

target_link_options(littoral_python PRIVATE -nodefaultlibs)
