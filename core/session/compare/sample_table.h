// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COMPARE_SAMPLE_TABLE_H
#define HN_SESSION_COMPARE_SAMPLE_TABLE_H
// Samples of a run, gathered row by row and written as columns.

#include "base/diag.h"
#include "base/strbuf.h"
#include "session/model/model.h"
#include "study/run/run.h"

#include <stdbool.h>

typedef struct hn_sample_table hn_sample_table;

/// Optional columns of a table of samples.
typedef struct hn_sample_columns {
    bool raw_lambda;       ///< the multipliers that the integrator itself computes
    bool reactions;        ///< forces and moments of joints and constraints, efforts of motors
    long long max_numbers; ///< bound of the whole table
} hn_sample_columns;

/// Makes a table for at most `cap` samples. The model must outlive it. Fails: HN_ERR_LIMIT (more
/// numbers than allowed; told in diags), HN_ERR_MEMORY, and where reactions cannot be computed.
HN_MUST_CHECK hn_status hn_sample_table_create(const hn_model *model, long long cap,
                                               const hn_sample_columns *columns,
                                               hn_sample_table **out, hn_diags *diags);
void hn_sample_table_free(hn_sample_table *tab); ///< NULL is legal

/// Adds a sample, whose multipliers are as unique as `mark` (hn_multiplier_mark) says. There must
/// be room. Reactions are null where the accelerations cannot be computed.
void hn_sample_table_add(hn_sample_table *tab, const hn_sample *s, int mark);
bool hn_sample_table_has_room(const hn_sample_table *tab);
long long hn_sample_table_count(const hn_sample_table *tab);
/// The time of the last sample [s]; 0 without samples.
double hn_sample_table_last_time(const hn_sample_table *tab);

/// Points *values to the sample added last as one list, in the order that hn_run_request.row says,
/// until the next call. Returns the number of values.
int hn_sample_table_row(const hn_sample_table *tab, const double **values);

/// Writes the names of all columns.
void hn_sample_table_put_names(hn_strbuf *b, const hn_sample_table *tab);
/// Writes "samples" with all columns.
void hn_sample_table_put(hn_strbuf *b, const hn_sample_table *tab);
/// Writes "samples" with the column "lambda_mark" alone: the others were handed out one by one.
void hn_sample_table_put_marks(hn_strbuf *b, const hn_sample_table *tab);

#endif
