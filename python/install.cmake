# The Python package: modules alone, nothing to build. Debian's Python finds it below /usr; for another prefix see docs/python.md.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/millscope DESTINATION lib/python3/dist-packages COMPONENT python FILES_MATCHING PATTERN "*.py"
        PATTERN __pycache__ EXCLUDE)
