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
endforeach()
