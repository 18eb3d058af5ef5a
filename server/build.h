// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BUILD_H
#define HN_BUILD_H
// Name and version of this program.

#define HN_VERSION "0.1.0"

/// "0.1.0 3f2a9c81d4e0 gcc 12.2.0": version, hash of the sources, compiler. Same scene, method and
/// build give the same numbers.
const char *hn_build_name(void);

#endif
