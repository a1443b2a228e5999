# SPDX-License-Identifier: Apache-2.0
# What find_package(takt) gives: the protocol code (Programs, OPC UA PubSub, DDS, the gateway) and the real node, for
# applications of others.
#
#   cmake --install build/release --component takt_library --prefix PREFIX
#
# Headers come to PREFIX/include/takt and are included as here: "pubsub/data_set.hpp", "node/real_node.hpp".
include(CMakePackageConfigHelpers)
install(FILES tools/wireshark/takt.lua DESTINATION ${CMAKE_INSTALL_DATADIR}/takt)

set(takt_installed takt_base takt_security takt_message_security takt_program takt_handshake takt_uadp takt_pubsub takt_dds
                   takt_gateway takt_wire takt_json takt_plant takt_node)
foreach(library ${takt_installed})
  string(REPLACE "takt_" "" name ${library})
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
  add_library(takt::${name} ALIAS ${library})
endforeach()
set_target_properties(takt_options PROPERTIES EXPORT_NAME options)
install(TARGETS takt_options ${takt_installed} EXPORT takt-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT takt_library)

set(takt_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/takt)
install(EXPORT takt-targets NAMESPACE takt:: DESTINATION ${takt_cmake_folder} COMPONENT takt_library)
foreach(module protocol/security protocol/program protocol/handshake protocol/uadp protocol/pubsub protocol/dds
        protocol/gateway protocol/wire foundation/plant foundation/json device/node)
  get_filename_component(folder ${module} NAME)
  install(DIRECTORY src/${module}/ DESTINATION ${TAKT_INCLUDE_FOLDER}/${folder} COMPONENT takt_library FILES_MATCHING PATTERN "*.hpp"
          PATTERN node/applications EXCLUDE PATTERN node/dds EXCLUDE PATTERN node/server EXCLUDE)  # parts of the command
endforeach()
install(FILES sim/time.hpp sim/units.hpp sim/check.hpp sim/octets.hpp DESTINATION ${TAKT_INCLUDE_FOLDER}/sim COMPONENT takt_library)
configure_package_config_file(cmake/takt-config.cmake.in ${PROJECT_BINARY_DIR}/takt-config.cmake INSTALL_DESTINATION ${takt_cmake_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/takt-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/takt-config.cmake ${PROJECT_BINARY_DIR}/takt-config-version.cmake DESTINATION ${takt_cmake_folder} COMPONENT takt_library)
