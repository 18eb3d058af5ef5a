// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BUILD_H
#define HN_BUILD_H
// What this program calls itself.

#define HN_VERSION "0.1.0"
#ifdef __clang__
#define HN_COMPILER "clang " __clang_version__
#else
#define HN_COMPILER "gcc " __VERSION__
#endif
/// Same scene, method and build give the same numbers; so the compiler is part of the name.
#define HN_BUILD HN_VERSION " " HN_COMPILER

#endif
