# Installs the program, the library with its headers, and what find_package(littoral) needs.
include(CMakePackageConfigHelpers)
set(littoral_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/littoral)

install(TARGETS littoral_cli RUNTIME)
install(TARGETS littoral EXPORT littoral_targets)
install(DIRECTORY include/littoral DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES python/torus_fit.txt DESTINATION ${CMAKE_INSTALL_DATADIR}/littoral)
install(EXPORT littoral_targets NAMESPACE littoral:: DESTINATION ${littoral_config_dir})

configure_package_config_file(cmake/littoral-config.cmake.in littoral-config.cmake
                              INSTALL_DESTINATION ${littoral_config_dir})
write_basic_package_version_file(littoral-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/littoral-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/littoral-config-version.cmake
        DESTINATION ${littoral_config_dir})

# Pages of the manual and completion scripts come from the program itself, where it runs here.
if(NOT CMAKE_CROSSCOMPILING)
  install(SCRIPT cmake/install_shell.cmake)
  install(CODE "littoral_install_shell($<TARGET_FILE:littoral_cli> ${CMAKE_INSTALL_MANDIR}/man1 ${CMAKE_INSTALL_DATADIR})")
endif()
