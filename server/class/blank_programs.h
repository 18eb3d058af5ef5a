// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_BLANK_PROGRAMS_H
#define HN_CLASS_BLANK_PROGRAMS_H
// The programs with blanks of a scene, one a language: what everyone of a class was given.

#include "class/fingerprint.h"
#include "session/model/library.h"
#include "session/model/model.h"

enum { HN_BLANK_PROGRAMS = 16 };

typedef struct hn_blank_programs {
    int n;
    struct hn_blank_program {
        const char *suffix; ///< of its files: ".py"
        hn_given_source *source;
    } of[HN_BLANK_PROGRAMS];
} hn_blank_programs;

/// Writes and reads the program of every language that can be graded; a language whose program
/// cannot be written is left out. hn_blank_programs_reset() in any case. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_blank_programs_init(hn_blank_programs *p, const hn_model *model,
                                               const hn_library *lib);
void hn_blank_programs_reset(hn_blank_programs *p);
/// Returns the given program in the language of this file, NULL: there is none.
const hn_given_source *hn_blank_programs_of(const hn_blank_programs *p, const char *file);

#endif
