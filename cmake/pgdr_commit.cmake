# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# Writes HEADER, with the commit that the sources in SOURCE are of: of their repository, with a + where files were changed since; else
# what `git archive` wrote into commit.txt; else nothing. Run with each build; the header changes only where the commit does.
# cmake -DSOURCE=<repository> -DHEADER=<file> -P pgdr_commit.cmake
set(commit "")
file(READ ${CMAKE_CURRENT_LIST_DIR}/commit.txt archived)
string(STRIP "${archived}" archived)
if(archived MATCHES "^[0-9a-f]+$")
  set(commit ${archived})
elseif(EXISTS ${SOURCE}/.git)
  find_program(git git)
  if(git)
    execute_process(COMMAND ${git} -C ${SOURCE} rev-parse --short=12 HEAD
      OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    execute_process(COMMAND ${git} -C ${SOURCE} diff --quiet HEAD RESULT_VARIABLE changed OUTPUT_QUIET ERROR_QUIET)
    if(commit AND changed EQUAL 1)
      string(APPEND commit "+")
    endif()
  endif()
endif()
set(words "")
if(commit)
  set(words " (${commit})")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define PGDR_COMMIT_WORDS \"${words}\"\n")
