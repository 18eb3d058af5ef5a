// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_FINGERPRINT_H
#define HN_CLASS_FINGERPRINT_H
// The share of their statements that two programs have in common. A statement is compared as the
// collection of its words: names of the student's own are all one, and neither their order nor
// brackets count. A statement that is added, or taken apart, leaves the others what they are.

#include "base/strbuf.h"
#include "class/source_text.h"

#include <stdbool.h>
#include <stdint.h>

enum { HN_FINGERPRINT_MOST = 256 };

/// A program that everyone is given: its statements are nobody's own.
typedef struct hn_given_source hn_given_source;

/// Reads a given program. Names before the words YOUR PART are known: they are told apart.
/// NULL: memory is out.
hn_given_source *hn_given_source_read(const char *text, hn_source_style style);
void hn_given_source_free(hn_given_source *given);

/// The statements of a program, sorted by their hash; of more than HN_FINGERPRINT_MOST those with
/// the least hashes, the same of every program.
typedef struct hn_fingerprint {
    int n;
    bool is_sample;
    struct hn_fingerprint_statement {
        uint32_t hash;
        uint8_t weight; ///< known names, functions and numbers in it
    } statement[HN_FINGERPRINT_MOST];
} hn_fingerprint;

/// Reads the statements of a program that the given one does not have and that hold at least two
/// known names, functions or numbers.
void hn_fingerprint_read(hn_fingerprint *f, const char *text, const hn_given_source *given);
/// Adds ten hex digits for each statement, "+" behind them if it is a sample.
void hn_fingerprint_put(hn_strbuf *b, const hn_fingerprint *f);
/// Reads what hn_fingerprint_put() wrote; n = 0 where it is something else.
void hn_fingerprint_parse(hn_fingerprint *f, const char *text);
/// Returns the share of the shorter one's statements that the other has too, by weight, 0 .. 1;
/// 0 where one of them is too short to tell.
double hn_fingerprint_share(const hn_fingerprint *a, const hn_fingerprint *b);

#endif
