# copy_page.cmake: the page's own files from FROM and the PALETTE of the pictures to TO, beside the libraries that lie there.
file(REMOVE_RECURSE ${TO}/src)
file(COPY ${PALETTE} DESTINATION ${TO})
file(COPY ${FROM}/ DESTINATION ${TO} PATTERN node_modules EXCLUDE PATTERN package.json EXCLUDE PATTERN package-lock.json EXCLUDE)
