// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_INSTALLED_H
#define HN_SESSION_INSTALLED_H
// The folder into which `make install` put the shipped files.

/// Absolute path of the folder that holds lessons/ and web/; "" in a library that is not installed.
/// `make install` compiles this one object again, and replaces it in the library that it installs.
extern const char hn_installed_home[];

#endif
