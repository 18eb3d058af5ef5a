// SPDX-License-Identifier: GPL-3.0-or-later
// A formula of matrices, compared with the reference at random matrices that have the properties
// their names stand for (J N = 0, M symmetric and definite): any form of a right answer is right.
#include "grade/parts/blank.h"
#include "grade/parts/formula_frame.h"
#include "grade/parts/part_list.h"
#include "grade/parts/read_as.h"
#include "grade/parts/world.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { WORLDS = 3 };
static const double ALLOWED = 1e-9; // of the largest entry; products of ten matrices err by 1e-13

static const struct {
    const char *id, *says;
    double factor, share;
} FACTORS[] = {
    {"sign", "the sign is wrong", -1, 0.5},
    {"double", "twice the right value", 2, 0.25},
    {"half", "half of the right value", 0.5, 0.25},
};

/// 1 when two formulas have the same values in every world, times a factor; transposed: the second
/// one is.
static int same(hn_world *worlds, const char *a, const char *b, double factor, int transposed) {
    char text[1200];
    snprintf(text, sizeof text, transposed ? "(%.1000s)'" : "%.1000s", b);
    for (int i = 0; i < WORLDS; i++) {
        hn_matrix x, y;
        if (hn_world_eval(&worlds[i], a, &x, NULL) != HN_OK ||
            hn_world_eval(&worlds[i], text, &y, NULL) != HN_OK ||
            !(hn_world_distance(&x, &y, factor) <= ALLOWED)) {
            return 0;
        }
    }
    return 1;
}

static const char *fault_answer(const cJSON *fault) {
    return hn_part_text(fault, "answer");
}

/// Returns whether two mistakes are in one term: in every world they change the reference in
/// proportion.
static bool is_one_term(const hn_part *p, hn_world *worlds, const cJSON *first,
                        const cJSON *second) {
    char text[1200];
    double ratio = 0;
    for (int i = 0; i < WORLDS; i++) {
        hn_matrix change[2];
        const cJSON *faults[2] = {first, second};
        for (int k = 0; k < 2; k++) {
            snprintf(text, sizeof text, "(%.500s)-(%.500s)", fault_answer(faults[k]),
                     hn_part_text(p->node, "answer"));
            if (hn_world_eval(&worlds[i], text, &change[k], NULL) != HN_OK) {
                return true;
            }
        }
        double largest = 0;
        const int n = change[1].rows * change[1].cols;
        for (int k = 0; i == 0 && k < n && n == change[0].rows * change[0].cols; k++) {
            if (fabs(change[1].x[k]) > largest) {
                largest = fabs(change[1].x[k]);
                ratio = change[0].x[k] / change[1].x[k];
            }
        }
        if (!(hn_world_distance(&change[0], &change[1], ratio) <= ALLOWED)) {
            return false;
        }
    }
    return true;
}

/// Two listed mistakes in different terms at once: the answer is a + b - reference, maybe with the
/// other sign.
static bool explain_two(const hn_part *p, hn_world *worlds, const char *given, hn_part_result *r) {
    const cJSON *first, *second;
    hn_strbuf both;
    bool found = false;
    hn_strbuf_init(&both);
    for (int i = 1; !found && (second = hn_part_fault_at(p, i)) != NULL; i++) {
        for (int j = 0; !found && j < i; j++) {
            first = hn_part_fault_at(p, j);
            hn_strbuf_clear(&both);
            hn_strbuf_printf(&both, "(%s)+(%s)-(%s)", fault_answer(first), fault_answer(second),
                             hn_part_text(p->node, "answer"));
            found = same(worlds, given, hn_strbuf_text(&both), 1, 0) &&
                    !is_one_term(p, worlds, first, second);
            if (found) {
                const double share = hn_part_number(first, "share", 0);
                hn_part_wrong(r, hn_part_text(first, "id"),
                              share * hn_part_number(second, "share", 0),
                              "two mistakes at once: %s; and %s", hn_part_text(first, "says"),
                              hn_part_text(second, "says"));
                r->alone = share;
            }
        }
    }
    hn_strbuf_reset(&both);
    return found;
}

/// Names the mistake in a formula that can be read.
static void explain(const hn_part *p, hn_world *worlds, const char *given, hn_part_result *r) {
    const char *reference = hn_part_text(p->node, "answer");
    const cJSON *fault;
    for (int i = 0; (fault = hn_part_fault_at(p, i)) != NULL; i++) {
        if (same(worlds, given, fault_answer(fault), 1, 0)) {
            hn_part_wrong(r, hn_part_text(fault, "id"), hn_part_number(fault, "share", 0), "%s",
                          hn_part_text(fault, "says"));
            return;
        }
    }
    for (size_t i = 0; i < sizeof FACTORS / sizeof *FACTORS; i++) {
        if (same(worlds, given, reference, FACTORS[i].factor, 0)) {
            hn_part_wrong(r, FACTORS[i].id, FACTORS[i].share, "%s", FACTORS[i].says);
            return;
        }
    }
    if (same(worlds, given, reference, 1, 1)) {
        hn_part_wrong(r, "transposed", 0.5, "this is the transpose of what is asked for");
        return;
    }

    // a listed mistake and a wrong sign at once
    for (int i = 0; (fault = hn_part_fault_at(p, i)) != NULL; i++) {
        if (same(worlds, given, fault_answer(fault), -1, 0)) {
            hn_part_wrong(r, hn_part_text(fault, "id"), hn_part_number(fault, "share", 0) / 2,
                          "%s; and the sign is wrong as well", hn_part_text(fault, "says"));
            return;
        }
    }
    if (!explain_two(p, worlds, given, r)) {
        hn_part_wrong(r, "other", 0, "wrong; the cause is none of the known mistakes");
    }
}

static const char *own_name(void *user, const char *name) {
    (void)user;
    return name;
}

/// Reads the answer in the first world; 0 after the result has said why it cannot be used.
static int can_read(hn_world *world, const char *text, hn_part_result *r) {
    hn_diag diag = {0};
    hn_strbuf read;
    hn_strbuf_init(&read);
    const hn_status status = hn_world_read(world, text, &read, &diag);
    if (status == HN_OK) {
        hn_read_as(text, hn_strbuf_text(&read), own_name, NULL, r->read_as, sizeof r->read_as);
    }
    hn_strbuf_reset(&read);
    if (status == HN_ERR_UNSUPPORTED || status == HN_ERR_SINGULAR) {
        hn_part_wrong(r, "shape", 0, "%s%s%s", diag.message, diag.hint[0] ? "; " : "", diag.hint);
    } else if (status != HN_OK) {
        hn_part_unreadable(r, "'%.60s' cannot be read: %.200s%s%.60s%s", text, diag.message,
                           diag.hint[0] ? "; did you mean '" : "", diag.hint,
                           diag.hint[0] ? "'?" : "");
    }
    return status == HN_OK;
}

static hn_status open_worlds(const hn_part *p, hn_world *worlds, hn_diag *diag) {
    hn_status status = HN_OK;
    for (int i = 0; i < WORLDS; i++) {
        worlds[i] = (hn_world){0};
        if (status == HN_OK) {
            status = hn_world_init(&worlds[i], p, p->seed + 77 * (uint64_t)i, diag);
        }
    }
    return status;
}

static void close_worlds(hn_world *worlds) {
    for (int i = 0; i < WORLDS; i++) {
        hn_world_reset(&worlds[i]);
    }
}

static hn_status grade(const hn_part *p, const cJSON *given, hn_part_result *r, int *n,
                       hn_diag *diag) {
    hn_world worlds[WORLDS];
    const char *written = cJSON_GetStringValue(given);
    const char *text = written ? hn_formula_behind_name(written) : NULL;

    const bool handed_in = hn_part_begin(r, n, given, "the formula");

    // equal formulas agree in every random world
    const hn_status status = open_worlds(p, worlds, diag);
    if (status == HN_OK && handed_in && !text) {
        hn_part_unreadable(r, "expected a formula of matrices in quotes");
    } else if (status == HN_OK && handed_in && can_read(&worlds[0], text, r)) {
        if (same(worlds, text, hn_part_text(p->node, "answer"), 1, 0)) {
            hn_part_right(r);
        } else {
            explain(p, worlds, text, r);
        }
    }

    // closed on every path
    close_worlds(worlds);
    return status;
}

static cJSON *right(const hn_part *p, hn_diag *diag) {
    (void)diag;
    return cJSON_CreateString(hn_part_text(p->node, "answer"));
}

static cJSON *fault(const hn_part *p, int i, const char **id, hn_diag *diag) {
    const cJSON *node = hn_part_fault_at(p, i);
    (void)diag;
    *id = hn_part_text(node, "id");
    return node ? cJSON_CreateString(fault_answer(node)) : NULL;
}

static hn_status prove(const hn_part *p, hn_diag *diag) {
    hn_world worlds[WORLDS];
    hn_status status = open_worlds(p, worlds, diag);
    const char *second = hn_part_text(p->node, "second");
    if (status == HN_OK && !same(worlds, hn_part_text(p->node, "answer"), second, 1, 0)) {
        status = hn_diag_set(diag, HN_ERR_INPUT, "/parts/second", NULL,
                             "part %s: the second form '%.80s' does not have the values of the "
                             "answer",
                             p->id, second);
    }
    close_worlds(worlds);
    return status;
}

static void ask(hn_strbuf *b, const hn_part *p) {
    const cJSON *m;
    hn_strbuf_add(b, "a formula of matrices in quotes, as \"J' * lambda\"; names:");
    cJSON_ArrayForEach(m, cJSON_GetObjectItemCaseSensitive(p->node, "matrices")) {
        hn_strbuf_printf(b, " %s", m->string);
    }
}

const hn_part_kind hn_part_matrix = {
    .name = "matrix",
    .fields = "sizes matrices answer second faults",
    .is_open = true,
    .ask = ask,
    .grade = grade,
    .blank = hn_blank_text,
    .right = right,
    .fault = fault,
    .prove = prove,
};
