// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_READER_H
#define HN_SESSION_EXTREME_READER_H
// Helpers for reading the files of the extreme matrix: the place in the file, faults, and values
// within bounds.

#include "session/extreme/extreme_internal.h"
#include "session/model/run_time.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

enum { HN_XR_TEXT = 1200, HN_XR_SCENES = 16 }; ///< bytes of a text, own scenes of a case
#define HN_XR_TIME HN_RUN_TIME_MAX             ///< [s]
#define HN_XR_NUMBER 1.7e308                   ///< of anything

typedef struct hn_xr {
    const hn_library *lib;
    hn_arena *arena;
    hn_diags *diags;
    hn_status status; ///< of the last fault
    const char *file;
    char path[160]; ///< JSON pointer of the place
    hn_extreme_case *c;
} hn_xr;

#define HN_XR_FIELDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/// Reports a fault at the present place, or at its member `key`.
void hn_xr_fault(hn_xr *r, const char *key, const char *hint, const char *format, ...)
    HN_PRINTF(4, 5);
/// Steps into a member, or an entry of it (index -1: the member); returns what hn_xr_leave() wants.
size_t hn_xr_enter(hn_xr *r, const char *key, int index);
void hn_xr_leave(hn_xr *r, size_t mark);
/// "did you mean 'x'?", or the list of what there is.
void hn_xr_suggest(char hint[HN_DIAG_HINT], const char *word, const char *const *names, int n);
/// Returns 1 for an object; members not among `fields`, or given twice, are reported as faults.
bool hn_xr_object(hn_xr *r, const cJSON *node, const char *const *fields);

/// The member of this name, NULL: there is none. The others report what is wrong with it and
/// return something legal: a text (NULL where it may be absent), a number within its bounds (the
/// lower one; `otherwise` where it is absent), true or false (absent: false).
const cJSON *hn_xr_get(const cJSON *object, const char *key);
const char *hn_xr_keep(hn_xr *r, const char *text); ///< a copy in the arena
const char *hn_xr_text(hn_xr *r, const cJSON *object, const char *key, bool required);
double hn_xr_check_number(hn_xr *r, const cJSON *m, const char *key, double low, double high);
double hn_xr_number(hn_xr *r, const cJSON *object, const char *key, double low, double high,
                    double otherwise);
bool hn_xr_flag(hn_xr *r, const cJSON *object, const char *key);
/// A number, or a formula in the trial's swept name; that it has a value is checked at the sweep's
/// first one.
hn_extreme_number hn_xr_formula(hn_xr *r, const cJSON *m, const char *key,
                                const hn_extreme_trial *trial, double low, double high);
/// Names with numbers or formulas under `key`; how many.
int hn_xr_assigns(hn_xr *r, const cJSON *object, const char *key, const hn_extreme_trial *trial,
                  hn_extreme_assign *out);
/// One text under `one`, or a list of at most HN_EXTREME_RUNS under `many`; how many.
int hn_xr_texts(hn_xr *r, const cJSON *object, const char *one, const char *many, const char **out);

#endif
