// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_PARTS_SPAN_H
#define HN_GRADE_PARTS_SPAN_H
// A stretch of a text that is not copied.

typedef struct hn_span {
    const char *at, *end; ///< from `at` up to `end`
} hn_span;

hn_span hn_span_trim(hn_span s); ///< without blanks at both ends

#endif
