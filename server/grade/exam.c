// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/exam.h"

#include "base/hash.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "expr/parse.h"
#include "grade/parts/spelling.h"
#include "grade/parts/value_sheet.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { MAX_DRAWS = 10000 };

/// Returns the index of a name or of one of its aliases, -1 if there is none.
static int find_name(const hn_exercise *p, const char *name) {
    for (int i = 0; i < p->n_aliases; i++) {
        if (strcmp(name, p->aliases[i].key) == 0) {
            name = p->aliases[i].text;
            break;
        }
    }
    for (int i = 0; i < p->n_names; i++) {
        if (strcmp(name, p->names[i].name) == 0) {
            return i;
        }
    }
    return -1;
}

/// The same, for the other spellings of a name too.
static int find_answer_name(const hn_exercise *p, const char *name) {
    char joined[64], other[64];
    int i = find_name(p, name);
    if (i < 0 && hn_spelling_join(name, joined, sizeof joined)) {
        i = find_name(p, joined);
        name = joined;
    }
    for (int k = 0; i < 0 && hn_spelling_alias(name, k, other, sizeof other); k++) {
        i = find_name(p, other);
    }
    return i;
}

const char *hn_exam_name(const hn_exam *exam, const char *name) {
    const int i = find_answer_name(exam->problem, name);
    return i >= 0 ? exam->problem->names[i].name : NULL;
}

static int lookup(void *user, const char *name, hn_ex *out) {
    hn_exam *exam = user;
    const int i = find_answer_name(exam->problem, name);
    if (i >= 0) {
        *out = hn_graph_symbol_expr(exam->graph, exam->symbol[i]);
    }
    return i >= 0;
}

hn_status hn_exam_parse(hn_exam *exam, const char *text, hn_ex *out, hn_diag *diag) {
    const hn_exercise *p = exam->problem;
    const char *known[HN_GRADE_MAX_NAMES];
    for (int i = 0; i < p->n_names; i++) {
        known[i] = p->names[i].name;
    }
    hn_parse_opts opts = {.lookup = lookup,
                          .user = exam,
                          .known = known,
                          .n_known = p->n_names,
                          .max_depth = 100,
                          .max_chars = HN_GRADE_MAX_FORMULA,
                          .shorten = "write it shorter"};
    hn_status status = hn_parse(exam->graph, text, &opts, out, diag);
    return hn_graph_failed(exam->graph) ? HN_ERR_MEMORY : status;
}

double hn_exam_value(hn_exam *exam, hn_ex e, int state) {
    // symbols were made in the order of the names
    return hn_graph_eval(exam->graph, e, exam->state[state]);
}

double hn_exam_allowed(const hn_exam *exam, double size) {
    return hn_value_allowed(exam->problem->relative, exam->problem->absolute, size);
}

/// The k-th random number in [0, 1) of a seed.
static double draw(uint64_t seed, uint64_t k) {
    return (double)(hn_hash_mix(seed + 0x9E3779B97F4A7C15ull * (k + 1)) >> 11) * 0x1p-53;
}

/// One state; 1 if every derived value lies in its range.
static int draw_state(hn_exam *exam, uint64_t seed, uint64_t *k, int closed, const hn_ex *derived,
                      int index) {
    const hn_exercise *p = exam->problem;
    double *x = exam->state[index];
    int fits = 1;
    for (int i = 0; i < p->n_names; i++) {
        x[i] = p->names[i].low + (p->names[i].high - p->names[i].low) * draw(seed, (*k)++);
    }
    double random[HN_GRADE_MAX_NAMES];
    memcpy(random, x, sizeof random);
    for (int i = 0; i < p->n_names && closed; i++) {
        if (p->names[i].formula) {
            x[i] = hn_graph_eval(exam->graph, derived[i], random);
            fits &= x[i] >= p->names[i].low && x[i] <= p->names[i].high;
        }
    }
    return fits;
}

static hn_status draw_states(hn_exam *exam, uint64_t seed, hn_diag *diag) {
    const hn_exercise *p = exam->problem;
    hn_ex derived[HN_GRADE_MAX_NAMES];
    for (int i = 0; i < p->n_names; i++) {
        if (p->names[i].formula) {
            HN_TRY(hn_exam_parse(exam, p->names[i].formula, &derived[i], diag));
        }
    }

    // states are drawn until the names that close the loop lie within their ranges
    uint64_t k = 0;
    int draws = 0;
    exam->n_states = p->n_closed + p->n_open;
    for (int s = 0; s < exam->n_states; s++) {
        while (!draw_state(exam, seed, &k, s < p->n_closed, derived, s)) {
            if (++draws > MAX_DRAWS) {
                return hn_diag_set(diag, HN_ERR_INPUT, "/parameters", NULL,
                                   "the loop does not close within the given ranges in %d draws",
                                   MAX_DRAWS);
            }
        }
    }
    return HN_OK;
}

/// The names as symbols of the graph, in their order.
static hn_status make_symbols(hn_exam *exam, hn_diag *diag) {
    const hn_exercise *p = exam->problem;
    for (int i = 0; i < p->n_names; i++) {
        hn_ex e = hn_symbol(exam->graph, p->names[i].name, NULL);
        exam->symbol[i] = hn_ex_symbol(exam->graph, e);
        if (exam->symbol[i] != i && !hn_graph_failed(exam->graph)) {
            return hn_diag_set(diag, HN_ERR_INPUT, "/coordinates", NULL,
                               "the name '%.40s' is given twice", p->names[i].name);
        }
    }
    return HN_OK;
}

/// phi, and its derivatives by the coordinates that the answer names.
static hn_status differentiate(hn_exam *exam, hn_diag *diag) {
    const hn_exercise *p = exam->problem;
    int by[HN_GRADE_MAX_COLUMNS];
    for (int j = 0; j < p->n_columns; j++) {
        by[j] = hn_graph_find_symbol(exam->graph, p->by[j]);
        if (by[j] < 0) {
            return hn_diag_set(diag, HN_ERR_INPUT, "/answer/by", NULL, "'%.40s' is no coordinate",
                               p->by[j]);
        }
    }
    for (int i = 0; i < p->n_rows; i++) {
        HN_TRY(hn_exam_parse(exam, p->phi[i], &exam->phi[i], diag));
        hn_diff(exam->graph, exam->phi[i], by, p->n_columns, &exam->reference[i * p->n_columns]);
    }
    return HN_OK;
}

/// The values of the reference at all states, and the size of each entry.
static hn_status evaluate(hn_exam *exam, hn_diag *diag) {
    const hn_exercise *p = exam->problem;
    for (int k = 0; k < p->n_rows * p->n_columns; k++) {
        for (int s = 0; s < exam->n_states; s++) {
            const double x = hn_exam_value(exam, exam->reference[k], s);
            if (!isfinite(x)) {
                return hn_diag_set(diag, HN_ERR_INPUT, "/phi", NULL,
                                   "the reference has no finite value at a random state");
            }
            exam->expected[k][s] = x;
            exam->size[k] = fmax(exam->size[k], fabs(x));
        }
    }
    return HN_OK;
}

static hn_status prepare(hn_exam *exam, uint64_t seed, hn_diag *diag) {
    HN_TRY(make_symbols(exam, diag));
    HN_TRY(differentiate(exam, diag));
    HN_TRY(draw_states(exam, seed, diag));
    return evaluate(exam, diag);
}

hn_status hn_exam_init(hn_exam *exam, const hn_exercise *problem, uint64_t seed, hn_diag *diag) {
    memset(exam, 0, sizeof *exam);
    exam->problem = problem;
    exam->graph = hn_graph_create();
    if (!exam->graph) {
        return HN_ERR_MEMORY;
    }

    // a graph without memory makes any other fault
    const hn_status status = prepare(exam, seed ? seed : problem->seed, diag);
    return hn_graph_failed(exam->graph) ? HN_ERR_MEMORY : status;
}

void hn_exam_reset(hn_exam *exam) {
    hn_graph_free(exam->graph);
    exam->graph = NULL;
}
