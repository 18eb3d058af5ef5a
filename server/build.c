// SPDX-License-Identifier: GPL-3.0-or-later
#include "build.h"

#include "sources_hash.h" // written by the Makefile

#ifdef __clang__
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

const char *hn_build_name(void) {
    return HN_VERSION " " HN_SOURCES_HASH " " COMPILER;
}
