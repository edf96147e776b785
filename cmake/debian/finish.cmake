# SPDX-License-Identifier: BSD-3-Clause
# Changes the staged files as required by Debian policy; CPack calls this script before it packs.
set(stage ${CPACK_TEMPORARY_INSTALL_DIRECTORY})

function(grouser_call)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(said "${said}" PARENT_SCOPE)
endfunction()

# Compress without a time stamp, for reproducible packages.
file(GLOB pages ${stage}/program/usr/share/man/man1/*.1)
grouser_call(gzip -9nf ${pages})

# Documents are in a folder named after the package, with copyright and Debian changelog.
if(CPACK_GROUSER_SUFFIX)
  file(RENAME ${stage}/program/usr/share/doc/grouser ${stage}/program/usr/share/doc/grouser${CPACK_GROUSER_SUFFIX})
endif()

# The file of pkg-config is in the folder of the architecture.
set(lib ${stage}/development/usr/lib)
if(CPACK_GROUSER_ARCHITECTURE)
  file(READ ${lib}/pkgconfig/grouser.pc text)
  string(REGEX REPLACE "\nprefix=[^\n]*" "\nprefix=/usr" text "${text}")
  file(WRITE ${lib}/${CPACK_GROUSER_ARCHITECTURE}/pkgconfig/grouser.pc "${text}")
  file(CHMOD ${lib}/${CPACK_GROUSER_ARCHITECTURE}/pkgconfig/grouser.pc PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  file(REMOVE_RECURSE ${lib}/pkgconfig)
endif()

grouser_call(date -R)
set(now "${said}")
foreach(component program development)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(folder ${stage}/${component}/usr/share/doc/${package})
  file(MAKE_DIRECTORY ${folder})
  configure_file(${CPACK_GROUSER_LICENSE} ${folder}/copyright COPYONLY)
  file(WRITE ${folder}/changelog "grouser (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * See CHANGELOG.md in the documentation of grouser.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
  grouser_call(gzip -9nf ${folder}/changelog)
  # pip names the tool that removes a package.
  file(GLOB installers ${stage}/${component}/usr/lib/python3/dist-packages/*.dist-info/INSTALLER)
  foreach(installer IN LISTS installers)
    file(WRITE ${installer} "debian\n")
  endforeach()
  # Some folders have the umask of this call, some files the permissions of the checkout.
  set(readable OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  set(searchable ${readable} OWNER_EXECUTE GROUP_EXECUTE WORLD_EXECUTE)
  file(CHMOD ${stage}/${component} PERMISSIONS ${searchable})
  file(CHMOD_RECURSE ${stage}/${component}/usr DIRECTORY_PERMISSIONS ${searchable})
  file(CHMOD_RECURSE ${folder} FILE_PERMISSIONS ${readable} DIRECTORY_PERMISSIONS ${searchable})
endforeach()
