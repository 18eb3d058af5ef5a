// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_LIST_TEXT_H
#define HN_GRADE_LIST_TEXT_H
// Matrices and lists that a student pasted as one text, from the program in which they stand:
//
//     [[a, b], [c, d]]    np.array([[a, b], [c, d]])    Matrix([[a, b], [c, d]])
//     {{a, b}, {c, d}}
//     [a, b; c, d]        [a b; c d]                    [[1 2]\n [3 4]]             J = [a b; c d];
//     \begin{pmatrix} a & b \\ c & d \end{pmatrix}
//
// In a row without commas blanks part the entries, as in MATLAB: "a -b" are two, "a - b" is one.

#include <cjson/cJSON.h>

/// The list, or list of rows, that a text holds, owned: numbers as numbers, other entries as texts.
/// NULL: the text is no list (a single formula in brackets is none), or no memory is left.
cJSON *hn_list_text_read(const char *text);

/// Replaces texts that hold lists by these: of the members of a submission, and of the members of
/// its answers. Names, comments and seeds stay. Writes the first one's name to `name` ("" if none)
/// and to *n_empty how many entries of all these lists are empty, as the second of "[a, , b]".
/// Returns how many lists there are.
int hn_list_text_expand(cJSON *submission, char *name, int size, int *n_empty);
#endif
