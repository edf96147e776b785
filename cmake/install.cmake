# SPDX-License-Identifier: BSD-3-Clause
# `cmake --install`: programs, assets, headers, exported targets, Python package, manual. Target uninstall.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# All users can read the installation, whatever the umask. CMake applies the umask to the folders that it creates for files,
# so these folders are created first; existing folders, such as the prefix, keep their permissions.
set(executable OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ OWNER_EXECUTE GROUP_EXECUTE WORLD_EXECUTE)
function(grouser_install_folders component)
  string(REPLACE ";" " " folders "${ARGN}")
  string(REPLACE ";" " " executable "${executable}")
  install(CODE "
    foreach(name ${folders})
      cmake_path(ABSOLUTE_PATH name BASE_DIRECTORY \"\${CMAKE_INSTALL_PREFIX}\" NORMALIZE OUTPUT_VARIABLE folder)
      set(folder \"\$ENV{DESTDIR}\${folder}\")
      set(missing \"\")
      set(at \"\${folder}\")
      while(NOT EXISTS \"\${at}\")
        list(APPEND missing \"\${at}\")
        cmake_path(GET at PARENT_PATH at)
      endwhile()
      file(MAKE_DIRECTORY \"\${folder}\")
      if(missing)
        file(CHMOD \${missing} PERMISSIONS ${executable})
      endif()
    endforeach()" COMPONENT ${component})
endfunction()
set(doc ${CMAKE_INSTALL_DOCDIR})
set(python ${GROUSER_PYTHON_DIR})
grouser_install_folders(program ${CMAKE_INSTALL_BINDIR} ${CMAKE_INSTALL_DATADIR}/grouser/assets
  ${CMAKE_INSTALL_DATADIR}/grouser/runs ${CMAKE_INSTALL_DATADIR}/grouser/python ${doc} ${CMAKE_INSTALL_MANDIR}
  ${python}/grouser ${python}/grouser-${PROJECT_VERSION}.dist-info)
grouser_install_folders(development ${CMAKE_INSTALL_INCLUDEDIR}/grouser/internal/runs
  ${CMAKE_INSTALL_LIBDIR}/cmake/grouser ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The program and its data, which the program finds in ../share/grouser (runs/support/locations.hpp).
set(share ${CMAKE_INSTALL_DATADIR}/grouser)
install(TARGETS grouser RUNTIME COMPONENT program)
install(DIRECTORY assets/meshes assets/heightmaps assets/vehicles assets/soils DESTINATION ${share}/assets COMPONENT program)
install(DIRECTORY runs/plots DESTINATION ${share}/runs COMPONENT program FILES_MATCHING PATTERN "*.py")
install(DIRECTORY runs/report DESTINATION ${share}/runs COMPONENT program FILES_MATCHING
  PATTERN "*.py" PATTERN "*.js" PATTERN "*.css" PATTERN "*.html" PATTERN "*.txt")
install(DIRECTORY runs/scenes DESTINATION ${share}/runs COMPONENT program FILES_MATCHING PATTERN "*.toml"
        PATTERN "*.json")
install(DIRECTORY runs/mechanisms DESTINATION ${share}/runs COMPONENT program FILES_MATCHING
  PATTERN "*.toml" PATTERN "*.csv" PATTERN "make_mechanisms.py" PERMISSIONS ${executable})
if(TARGET grouser_python)
  install(TARGETS grouser_python LIBRARY DESTINATION ${GROUSER_PYTHON_DIR}/grouser COMPONENT program)
endif()
install(DIRECTORY python/grouser DESTINATION ${GROUSER_PYTHON_DIR} COMPONENT program FILES_MATCHING
  PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed")
# Metadata for importlib.metadata and pip. Without a file RECORD, pip does not remove files that CMake installed.
configure_file(python/METADATA.in python/METADATA @ONLY)
file(WRITE ${PROJECT_BINARY_DIR}/python/INSTALLER "cmake\n")
install(FILES ${PROJECT_BINARY_DIR}/python/METADATA ${PROJECT_BINARY_DIR}/python/INSTALLER
  DESTINATION ${GROUSER_PYTHON_DIR}/grouser-${PROJECT_VERSION}.dist-info COMPONENT program)

# Documents and examples; cmake/documents.py adjusts paths to the installation.
find_program(GROUSER_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
install(DIRECTORY python/examples DESTINATION ${share}/python COMPONENT program
  FILES_MATCHING PATTERN "*.py" PERMISSIONS ${executable})
install(DIRECTORY tests/install/example DESTINATION ${share} COMPONENT program)
install(PROGRAMS runs/slurm.sh DESTINATION ${share}/runs COMPONENT program)
install(FILES CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
  PATTERN docs/site EXCLUDE PATTERN "*.md" EXCLUDE)
install(CODE "execute_process(COMMAND \"${GROUSER_PYTHON}\" -B \"${PROJECT_SOURCE_DIR}/cmake/documents.py\"
  \"\${CMAKE_INSTALL_PREFIX}\" \"${share}\" \"${CMAKE_INSTALL_DOCDIR}\" \"${GROUSER_PYTHON_DIR}\"
  OUTPUT_VARIABLE documents COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES \${documents})"
  COMPONENT program)

# Manual pages and completion, generated from --help.
set(manual ${CMAKE_CURRENT_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${manual}/man/man1/grouser.1
  COMMAND grouser manual --folder ${manual} DEPENDS grouser COMMENT "Writing the manual" VERBATIM)
add_custom_target(grouser_manual ALL DEPENDS ${manual}/man/man1/grouser.1)
install(DIRECTORY ${manual}/man/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(DIRECTORY ${manual}/bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program)

# The libraries: `find_package(grouser)` and the target grouser::grouser for the headers <grouser/...>. The unstable
# headers of the rooms are below <grouser/internal/...>: target grouser::internal.
set(rooms base contact fluid spheredecomp multibody terrain scm vehicle coupling)
set(program_rooms support scene setup storage output render session)
set(targets grouser_flags grouser_api)
foreach(room ${rooms} ${program_rooms})
  list(APPEND targets grouser_${room})
  set_target_properties(grouser_${room} PROPERTIES EXPORT_NAME ${room})
endforeach()
set_target_properties(grouser_flags PROPERTIES EXPORT_NAME flags)
set_target_properties(grouser_api PROPERTIES EXPORT_NAME grouser)
add_library(grouser::grouser ALIAS grouser_api)
add_library(grouser_internal INTERFACE)
set_target_properties(grouser_internal PROPERTIES EXPORT_NAME internal)
target_include_directories(grouser_internal INTERFACE $<INSTALL_INTERFACE:include/grouser/internal>)
target_link_libraries(grouser_internal INTERFACE grouser_api $<INSTALL_INTERFACE:OpenMP::OpenMP_CXX>)
# The internal headers contain code that computes the state: without these options, results have other bits.
target_compile_options(grouser_internal INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>
  $<INSTALL_INTERFACE:-Wno-psabi>)
target_compile_definitions(grouser_api INTERFACE
  "$<INSTALL_INTERFACE:GROUSER_INSTALLED_SHARE=\"$<INSTALL_PREFIX>/${share}\">")
install(TARGETS grouser_internal ${targets} EXPORT grouser_targets ARCHIVE COMPONENT development)
install(DIRECTORY api/include/grouser DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
set(internal ${CMAKE_INSTALL_INCLUDEDIR}/grouser/internal)
foreach(room ${rooms})
  install(DIRECTORY ${room} DESTINATION ${internal} COMPONENT development
    FILES_MATCHING PATTERN "*.hpp" PATTERN "*.cuh" PATTERN detail EXCLUDE)
endforeach()
foreach(room ${program_rooms})
  install(DIRECTORY runs/${room} DESTINATION ${internal}/runs COMPONENT development
    FILES_MATCHING PATTERN "*.hpp" PATTERN detail EXCLUDE)
endforeach()
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/grouser)
install(EXPORT grouser_targets NAMESPACE grouser:: DESTINATION ${config} COMPONENT development)
set(GROUSER_CONFIG_CUDA "")
if(GROUSER_CUDA)
  set(GROUSER_CONFIG_CUDA "find_dependency(CUDAToolkit)")
endif()
configure_package_config_file(cmake/package_config.cmake grouser-config.cmake INSTALL_DESTINATION ${config})
write_basic_package_version_file(grouser-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/grouser-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/grouser-config-version.cmake
  DESTINATION ${config} COMPONENT development)

# pkg-config. The libraries are static: the linker reads them in the order of a group, then their dependencies.
set(libs "")
foreach(room api ${program_rooms} ${rooms})
  string(APPEND libs " -lgrouser_${room}")
endforeach()
if(GROUSER_CUDA)
  string(APPEND libs " -L${CUDAToolkit_LIBRARY_DIR} -lcudart_static -lrt -ldl -lpthread")
endif()
file(RELATIVE_PATH up /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" up ${up})
configure_file(cmake/grouser.pc.in grouser.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/grouser.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

add_custom_target(uninstall COMMENT "Removing the installed files" VERBATIM
  COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -P ${PROJECT_SOURCE_DIR}/cmake/uninstall.cmake)

include(cmake/package.cmake)
