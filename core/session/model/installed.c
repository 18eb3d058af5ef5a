// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/installed.h"

#ifndef HN_INSTALLED_HOME
#define HN_INSTALLED_HOME ""
#endif

const char hn_installed_home[] = HN_INSTALLED_HOME;
