// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPORT_LANGUAGE_H
#define HN_EXPORT_LANGUAGE_H
// The programming languages that equations can be written in, as one table. A row says how a
// number, an operator and an assignment are spelled; the rest of a program is a text with places to
// fill, core/export/NAME.txt.

#include "base/strbuf.h"
#include "expr/ops.h"

#include <stdbool.h>

/// One of several ways in which programs of a language solve: `--solver`. In the text with places
/// its lines stand behind @IF NAME@.
typedef struct hn_language_solver {
    const char *name;  ///< "eigen"
    const char *about; ///< one line: what it solves, and what it needs
} hn_language_solver;

typedef struct hn_language {
    const char *name;        ///< "python"; also the name of the text with places: python.txt
    const char *suffix;      ///< of a file: ".py"
    const char *about;       ///< one line for a list: what the program needs
    const char *comment;     ///< begins a comment
    const char *comment_end; ///< ends it where the end of the line does not; else NULL
    const char *constant;    ///< declares a number: #1 the name, #2 the value
    const char *vector;      ///< assigns an entry: #1 the array, #2 its index, #3 the value
    const char *matrix;      ///< likewise: #1, #2 row, #3 column, #4 the value
    const char *entry;       ///< reads an entry of a vector: #1 the array, #2 its index
    int first;               ///< index of the first entry
    bool needs_point;        ///< 1 / 2 would divide whole numbers
    const char *times;       ///< between factors; NULL: "*"
    const char *fraction;    ///< #1 over #2, for numbers to read; NULL: decimals
    /// a power, #1 the exponent, in a language of formulas to read (export/formula.h); else NULL
    const char *raised;
    const char *given; ///< a given number of 6 digits, #1; NULL: with all its digits
    const char *named; ///< says what an entry is: #1 as `entry`, #2 the name; NULL: a comment
    /// in a language of formulas to read: what stands before the pieces of each kind
    /// (export/formula.h), and behind one the names it depends on, #1; else NULL
    const char *pieces[3], *depends;
    const char *numbers;  ///< what stands before the table of long numbers; NULL: there is none
    const char *power;    ///< a number with a power of ten: #1 times 10^#2; NULL: as 1e-7
    const char *reserved; ///< words that no symbol may have, separated by spaces
    /// writes a name of the scene, the name of an array, words in a comment; NULL: as they are
    void (*put_name)(hn_strbuf *b, const char *name);
    void (*put_array)(hn_strbuf *b, const char *name);
    void (*put_words)(hn_strbuf *b, const char *words);
    void (*put_unit)(hn_strbuf *b, const char *unit); ///< NULL: as words
    /// the ways to solve, behind each other up to one without a name; the first when none is asked
    /// for; NULL: there is one way only
    bool has_steps; ///< its text repeats the steps of a method with its first solver
    const hn_language_solver *solvers;
    /// how functions are called: #1 and #2 for the arguments; NULL: as in a scene, name(#1, #2)
    const char *call[HN_OP_COUNT];
} hn_language;

/// The table; `n` gets the number of rows. Static.
const hn_language *hn_languages(int *n);
/// The row of this name, or NULL.
const hn_language *hn_language_find(const char *name);

#endif
