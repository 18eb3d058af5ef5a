// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/summary.h"

#include <stdio.h>
#include <string.h>

/// 1 if column j is wrong by its sign in every row.
static int column_has_sign(const hn_verdict *v, int j) {
    int n = v->problem->n_columns, all = 1;
    for (int i = 0; i < v->problem->n_rows; i++) {
        all &= strcmp(v->entry[i * n + j].mistake, "sign") == 0;
    }
    return all;
}

/// The columns whose sign is wrong in every row, as "1, 3"; returns how many.
static int list_sign_columns(const hn_verdict *v, char *list, size_t size) {
    int columns = 0;
    list[0] = 0;
    for (int j = 0; j < v->problem->n_columns; j++) {
        if (column_has_sign(v, j)) {
            const size_t used = strlen(list);
            snprintf(list + used, size - used, "%s%d", columns++ ? ", " : "", j + 1);
        }
    }
    return columns;
}

/// The mistake that all wrong entries share; "" when they do not.
static const char *common_mistake(const hn_verdict *v) {
    const char *common = NULL;
    for (int k = 0; k < v->n_entries; k++) {
        const hn_entry_verdict *e = &v->entry[k];
        if (!e->right) {
            common = !common ? e->mistake : strcmp(common, e->mistake) == 0 ? common : "";
        }
    }
    return common ? common : "";
}

/// The entries that cannot be read, behind the rest of the sentence.
static void add_unreadable(hn_verdict *v) {
    if (v->n_unreadable == 0) {
        return;
    }
    size_t used = strlen(v->summary);
    used += (size_t)snprintf(v->summary + used, sizeof v->summary - used,
                             "; %d cannot be read: ", v->n_unreadable);
    for (int k = 0, n = 0; k < v->n_entries && used < sizeof v->summary; k++) {
        if (strcmp(v->entry[k].mistake, "unreadable") == 0) {
            used += (size_t)snprintf(v->summary + used, sizeof v->summary - used, "%s%s",
                                     n++ ? ", " : "", v->entry[k].name);
        }
    }
}

void hn_summary_write(hn_verdict *v) {
    char list[64];
    const int wrong = v->n_entries - v->n_right;
    const int columns = list_sign_columns(v, list, sizeof list);
    const char *common = common_mistake(v);

    // a mistake with one cause is named rather than counted
    if (wrong == 0) {
        snprintf(v->summary, sizeof v->summary, "all %d entries are right", v->n_entries);
    } else if (columns > 0 && columns * v->problem->n_rows == wrong &&
               columns < v->problem->n_columns) {
        snprintf(v->summary, sizeof v->summary,
                 "column%s %s: wrong sign in every row; check the side of the loop equation on "
                 "which these links are",
                 columns > 1 ? "s" : "", list);
    } else if (wrong > 1 && common[0] && strcmp(common, "other") != 0 && v->n_unreadable == 0) {
        snprintf(v->summary, sizeof v->summary,
                 "%d of %d entries are right; the other %d share one mistake: %s", v->n_right,
                 v->n_entries, wrong, common);
    } else {
        snprintf(v->summary, sizeof v->summary, "%d of %d entries are right", v->n_right,
                 v->n_entries);
    }
    add_unreadable(v);
}
