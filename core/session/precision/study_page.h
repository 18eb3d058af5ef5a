// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STUDY_PAGE_H
#define HN_SESSION_STUDY_PAGE_H
// Sections shared by the page of one study (study_html.c) and the report over several
// (report_html.c).

#include "render/look.h"
#include "session/precision/study_plot.h"

// sections with heads of that level, 2 or 3
#endif
