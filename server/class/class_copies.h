// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_CLASS_COPIES_H
#define HN_CLASS_CLASS_COPIES_H
// Submissions of a class that are the same: the words of the summary, beside each submission.

#include "class/class_grading.h"
#include "class/fingerprint.h"

/// Features by which graded submissions are compared.
typedef struct hn_class_copy {
    char student[128], texts[20], shape[20]; ///< texts "": it is compared with none
    hn_fingerprint own;                      ///< of a program
} hn_class_copy;

typedef struct hn_class_copies {
    int n;
    bool programs;
    hn_class_copy *item; ///< n, in the order of the class; owned, NULL: memory is out
} hn_class_copies;

/// Reads the lines of a class. Right answers are alike by nature and are not compared; right
/// programs are. hn_class_copies_reset() in any case.
void hn_class_copies_find(hn_class_copies *c, const hn_class_result *r, bool programs);
void hn_class_copies_reset(hn_class_copies *c);
/// Returns the words for what near-copies share: "the same but for the names", of programs also
/// comments and order.
const char *hn_class_copies_near(bool programs);
/// Adds "the same as Ann, Bob", hn_class_copies_near() with " as Eve" and "shares 92 % of its
/// statements with Ned" for submission i, after "; " where the buffer is not empty; nothing where
/// it is like no other.
void hn_class_copies_put(hn_strbuf *b, const hn_class_copies *c, int i);
/// Adds the pairs of programs that share most of their statements and are more than near-copies,
/// the most alike first, at most 30, under a heading with the least share; nothing where there is
/// none.
void hn_class_copies_put_alike(hn_strbuf *b, const hn_class_copies *c);

#endif
