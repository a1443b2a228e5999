# SPDX-License-Identifier: Apache-2.0
# Debian packages: takt, takt-dev, python3-takt, and debug symbols where there are some (TAKT_DEBUG_SYMBOLS).
#
#   tools/packages        builds them into build/packages
#
# Man pages, completions and the systemd unit go with the command. What lintian says of the packages is argued in
# cmake/debian/.

set(manuals ${PROJECT_BINARY_DIR}/manuals)
find_program(TAKT_MANUALS_PYTHON python3)
if(TAKT_MANUALS_PYTHON)
  add_custom_command(OUTPUT ${manuals}/done COMMAND ${TAKT_MANUALS_PYTHON} ${PROJECT_SOURCE_DIR}/tools/manuals $<TARGET_FILE:takt> ${manuals} COMMAND ${CMAKE_COMMAND} -E touch ${manuals}/done
                     DEPENDS takt_programs ${PROJECT_SOURCE_DIR}/tools/manuals VERBATIM)
  add_custom_target(takt_manuals DEPENDS ${manuals}/done)
endif()
install(DIRECTORY ${manuals}/man1 ${manuals}/man5 DESTINATION share/man COMPONENT takt_manuals OPTIONAL)
install(FILES ${manuals}/bash/takt DESTINATION share/bash-completion/completions COMPONENT takt_manuals OPTIONAL)
install(FILES ${manuals}/zsh/_takt DESTINATION share/zsh/vendor-completions COMPONENT takt_manuals OPTIONAL)
install(FILES ${manuals}/fish/takt.fish DESTINATION share/fish/vendor_completions.d COMPONENT takt_manuals OPTIONAL)
install(FILES cmake/debian/takt-node@.service DESTINATION lib/systemd/system COMPONENT takt_manuals)
install(DIRECTORY scenarios devices DESTINATION share/takt COMPONENT takt_manuals)

# What a package must have beside its files.
find_program(TAKT_GZIP gzip)
if(TAKT_GZIP)
  file(READ cmake/debian/changelog.in changelog)
  string(CONFIGURE "${changelog}" changelog @ONLY)
  file(WRITE ${PROJECT_BINARY_DIR}/debian/changelog.Debian "${changelog}")
  execute_process(COMMAND ${TAKT_GZIP} -9nkf ${PROJECT_BINARY_DIR}/debian/changelog.Debian)
  foreach(package IN ITEMS takt:takt_manuals takt-dev:takt_library python3-takt:takt_python)
    string(REPLACE ":" ";" pair ${package})
    list(GET pair 0 name)
    list(GET pair 1 component)
    if(name STREQUAL "python3-takt" AND NOT TARGET takt_python)
      continue()
    endif()
    install(FILES cmake/debian/copyright DESTINATION share/doc/${name} COMPONENT ${component})
    install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.Debian.gz DESTINATION share/doc/${name} RENAME changelog.gz
      COMPONENT ${component})
    if(EXISTS ${PROJECT_SOURCE_DIR}/cmake/debian/${name}.lintian-overrides)
      install(FILES cmake/debian/${name}.lintian-overrides DESTINATION share/lintian/overrides RENAME ${name}
        COMPONENT ${component})
    endif()
  endforeach()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME takt)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The takt authors <takt@localhost.localdomain>")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEBUGINFO_PACKAGE ${TAKT_DEBUG_SYMBOLS})
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)

# A component is a package; the command comes with its manuals.
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL takt_command takt_manuals takt_library)
set(CPACK_COMPONENT_TAKT_COMMAND_GROUP takt)
set(CPACK_COMPONENT_TAKT_MANUALS_GROUP takt)
set(CPACK_COMPONENT_TAKT_LIBRARY_GROUP takt-dev)
set(CPACK_DEBIAN_TAKT_PACKAGE_NAME takt)
set(CPACK_DEBIAN_TAKT_PACKAGE_SECTION net)
set(CPACK_DEBIAN_TAKT_DESCRIPTION "simulator of TSN networks that run distributed OPC UA Programs
takt simulates TSN networks whose nodes run distributed OPC UA Programs,
down to the picosecond and reproducibly to the bit. From the same file it
bounds reactions, searches for the worst run, proves the handshake, and
starts real nodes with the same code.")
set(CPACK_DEBIAN_TAKT-DEV_PACKAGE_NAME takt-dev)
set(CPACK_DEBIAN_TAKT-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_TAKT-DEV_PACKAGE_DEPENDS "libfmt-dev, nlohmann-json3-dev, libssl-dev")
set(CPACK_DEBIAN_TAKT-DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_TAKT-DEV_DESCRIPTION "Programs, PubSub, DDS and gateways of takt for own applications
The protocol code that takt simulates, and the real node that hosts it: for
applications that are Programs themselves. find_package(takt) finds it.")
if(TARGET takt_python)
  list(APPEND CPACK_COMPONENTS_ALL takt_python)
  set(CPACK_COMPONENT_TAKT_PYTHON_GROUP python3-takt)
  set(CPACK_DEBIAN_PYTHON3-TAKT_PACKAGE_NAME python3-takt)
  set(CPACK_DEBIAN_PYTHON3-TAKT_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON3-TAKT_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
  set(CPACK_DEBIAN_PYTHON3-TAKT_PACKAGE_SUGGESTS "python3-pandas")
  set(CPACK_DEBIAN_PYTHON3-TAKT_DESCRIPTION "simulator of TSN networks, as a Python module
takt for Python and notebooks: load, run, bound and verify scenarios, run
studies, and have frames and latencies as NumPy arrays without copies.")
endif()
include(CPack)
