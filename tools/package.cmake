# What `cpack` makes: a Debian package of the program and its assets, without headers and libraries.
# OSMesa is opened when the first picture is drawn and the fonts are read then, so neither is found by linking.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ukemi)
set(CPACK_PACKAGE_VENDOR "ukemi")
set(CPACK_PACKAGE_CONTACT "ukemi <ukemi@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "bakes hit reactions of humanoid characters as animation clips")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
    "A humanoid character and a blow go in, a clip comes out in which the
 character flinches, staggers, falls and gets up as a person would.
 Reads glTF, VRM, FBX, DAE and BVH; writes glTF, FBX and BVH.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME ukemi)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libosmesa6, fonts-dejavu-core")

set(documents ${CMAKE_INSTALL_DATADIR}/doc/ukemi)
install(FILES LICENSE DESTINATION ${documents} RENAME copyright COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${documents} COMPONENT program)
include(CPack)
