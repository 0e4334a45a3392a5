# Run by CPack when the files are staged: /usr/share/doc/<package> has the copyright in Debian's format, in place of
# LICENSE, and a changelog.
set(doc ${CPACK_TEMPORARY_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX}/share/doc)
file(REMOVE_RECURSE ${doc}/textplane)
file(MAKE_DIRECTORY ${doc}/libtextplane-dev)
configure_file(${CPACK_TEXTPLANE_SOURCE}/packaging/debian/copyright ${doc}/libtextplane-dev/copyright COPYONLY)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${doc}/libtextplane-dev/changelog "libtextplane-dev (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * textplane ${CPACK_PACKAGE_VERSION}. What is new: CHANGELOG.md of the sources.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
execute_process(COMMAND gzip -9n ${doc}/libtextplane-dev/changelog COMMAND_ERROR_IS_FATAL ANY)
