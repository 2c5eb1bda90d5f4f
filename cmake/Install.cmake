# What `cmake --install` leaves: the program, the libraries with their headers, the maps, and
# find_package(articap) with the targets articap::core, articap::rig, ...
include(CMakePackageConfigHelpers)

set(ARTICAP_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/articap)

# Called once, after all folders are known.
function(articap_install_folders)
  foreach(folder IN LISTS ARGN)
    if(NOT TARGET articap_${folder})
      continue()
    endif()
    install(TARGETS articap_${folder} EXPORT articap-targets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/articap/${folder}
            FILES_MATCHING PATTERN "*.h" PATTERN node_modules EXCLUDE)
  endforeach()
  install(FILES ${PROJECT_BINARY_DIR}/generated/core/version.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/articap/core)
  if(EXISTS ${PROJECT_SOURCE_DIR}/maps)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/maps DESTINATION ${CMAKE_INSTALL_DATADIR}/articap)
  endif()
  install(EXPORT articap-targets NAMESPACE articap:: DESTINATION ${ARTICAP_CMAKE_DIR})
  configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/articap-config.cmake.in
    ${PROJECT_BINARY_DIR}/articap-config.cmake INSTALL_DESTINATION ${ARTICAP_CMAKE_DIR})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/articap-config-version.cmake
                                   COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/Dependencies.cmake
                ${PROJECT_BINARY_DIR}/articap-config.cmake
                ${PROJECT_BINARY_DIR}/articap-config-version.cmake
          DESTINATION ${ARTICAP_CMAKE_DIR})
endfunction()
