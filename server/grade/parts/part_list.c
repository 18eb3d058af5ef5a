// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/part_list.h"

#include "base/suggest.h"

#include <string.h>

static const struct {
    const char *name;
    double minutes; ///< that such a part takes a student who has read the lesson, estimated
    const hn_part_kind *kind;
} KINDS[] = {
    {"number", 2.5, &hn_part_values},
    {"vector", 4, &hn_part_values},
    {"formula", 4, &hn_part_values},
    {"formulas", 6, &hn_part_values},
    {"choice", 2, &hn_part_choice},
    {"matrix", 8, &hn_part_matrix},
    {"blocks", 12, &hn_part_blocks},
    {"basis", 8, &hn_part_basis},
    {"example", 8, &hn_part_example},
    {"order", 12, &hn_part_order},
    {"method", 12, &hn_part_method},
    {"reading", 3, &hn_part_reading},
    {"configuration", 5, &hn_part_configuration},
    {"scene", 8, &hn_part_scene},
};
enum { N_KINDS = sizeof KINDS / sizeof *KINDS };

/// The kind of a name ("number", "choice" ...); NULL with a near miss in diag.
static const hn_part_kind *find_kind(const char *name, hn_diag *diag) {
    const char *names[N_KINDS];
    for (int i = 0; i < N_KINDS; i++) {
        names[i] = KINDS[i].name;
        if (strcmp(KINDS[i].name, name) == 0) {
            return KINDS[i].kind;
        }
    }
    char hint[HN_DIAG_HINT];
    hn_suggest_or_list(hint, name, names, N_KINDS, "kinds: ");
    hn_diag_set(diag, HN_ERR_INPUT, "/parts/kind", hint, "there is no kind of answer '%.40s'",
                name);
    return NULL;
}

double hn_part_minutes(const char *kind) {
    for (int i = 0; i < N_KINDS; i++) {
        if (strcmp(KINDS[i].name, kind) == 0) {
            return KINDS[i].minutes;
        }
    }
    return 0;
}

/// 1 when the word stands in a list separated by blanks.
static int lists(const char *list, const char *word) {
    const size_t n = strlen(word);
    for (const char *p = strstr(list, word); p; p = strstr(p + 1, word)) {
        if ((p == list || p[-1] == ' ') && (p[n] == ' ' || p[n] == 0)) {
            return 1;
        }
    }
    return 0;
}

hn_status hn_part_open(hn_part *p, const cJSON *node, hn_diag *diag) {
    // what all kinds have
    p->node = node;
    p->id = hn_part_text(node, "id");
    p->points = hn_part_number(node, "points", -1);
    p->kind = find_kind(hn_part_text(node, "kind"), diag);
    if (!p->kind) {
        return HN_ERR_INPUT;
    }

    // the id is a key of the submission
    if (!p->id[0] || strlen(p->id) > 16 || !(p->points >= 0)) {
        return hn_diag_set(diag, HN_ERR_INPUT, "/parts", NULL,
                           "a part needs an id of 1 to 16 characters and points from 0");
    }

    // a field that nobody reads is a slip of the author
    const cJSON *m;
    cJSON_ArrayForEach(m, node) {
        if (!lists("id kind points ask about", m->string) && !lists(p->kind->fields, m->string)) {
            return hn_diag_set(diag, HN_ERR_INPUT, "/parts", p->kind->fields,
                               "part %s has a field '%.40s' that this kind does not read", p->id,
                               m->string);
        }
    }
    return HN_OK;
}
