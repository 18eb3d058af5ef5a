// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STYLE_H
#define HN_SESSION_STYLE_H
// The style sheets of documents that are pages or plots. Each is a file NAME.css of this folder;
// the build writes it into the library as hn_style_NAME. Colours are the variables that
// hn_page_theme() writes.

extern const char hn_style_page[], hn_style_plots[];
extern const char hn_style_budget[], hn_style_extreme[], hn_style_report[]; ///< after hn_style_page

#endif
