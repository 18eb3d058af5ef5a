// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/other_variant.h"

#include "grade/parts/part_list.h"

#include <stdio.h>
#include <string.h>

enum { SMALL_SEEDS = 8, LEAST = 2, MAX_WRONG = 16 };

/// A number that is wrong in this variant.
typedef struct wrong_number {
    int part, result; ///< of the exercise; among the results of the part
} wrong_number;

/// Whether the answers of a part are numbers, which differ from variant to variant.
static bool has_numbers(const hn_part *p) {
    const char *kind = hn_part_text(p->node, "kind");
    return strcmp(kind, "number") == 0 || strcmp(kind, "vector") == 0;
}

/// The wrong numbers that were handed in; entries of a verdict follow the parts.
static int list_wrong(const hn_variant *x, const hn_verdict *v, wrong_number list[MAX_WRONG]) {
    int n = 0, entry = 0;
    for (int i = 0; i < x->n_parts; i++) {
        const size_t length = strlen(x->part[i].id);
        for (int k = 0; entry < v->n_entries; k++, entry++) {
            const hn_entry_verdict *e = &v->entry[entry];
            const bool own = strncmp(e->name, x->part[i].id, length) == 0 &&
                             (e->name[length] == '.' || !e->name[length]);
            if (!own) {
                break;
            }
            if (!e->right && e->given[0] && has_numbers(&x->part[i]) && n < MAX_WRONG &&
                strcmp(e->mistake, "unreadable") != 0) {
                list[n++] = (wrong_number){.part = i, .result = k};
            }
        }
    }
    return n;
}

/// Whether all of the wrong numbers but one are right in the variant of this seed.
static bool fits(const hn_exercise *exercise, uint64_t seed, const cJSON *submission,
                 const wrong_number *list, int n) {
    hn_variant other;
    hn_diag diag = {0};
    int missed = 0;
    bool good = hn_variant_init(&other, exercise, seed, &diag) == HN_OK;
    for (int i = 0; i < n && good && missed < 2; i++) {
        hn_part_result results[HN_PART_RESULTS];
        int count = 0;
        const hn_part *p = &other.part[list[i].part];
        good = p->kind->grade(p, cJSON_GetObjectItemCaseSensitive(submission, p->id), results,
                              &count, &diag) == HN_OK;
        missed += good && !(list[i].result < count && results[list[i].result].right);
    }
    hn_variant_reset(&other);
    return good && missed < 2 && n - missed >= LEAST;
}

/// Looks for the variant among the owners and a few small seeds.
static bool find_owner(const hn_variant *x, const cJSON *submission, const hn_verdict *v,
                       hn_variant_owner *out) {
    const hn_exercise *e = x->exercise;
    wrong_number list[MAX_WRONG];
    const int n = list_wrong(x, v, list);
    for (int i = 0; i < e->n_owners + SMALL_SEEDS && n >= LEAST; i++) {
        const hn_variant_owner seed = {.seed = (uint64_t)(i - e->n_owners + 1)};
        *out = i < e->n_owners ? e->owners[i] : seed;
        if (out->seed != x->seed && fits(e, out->seed, submission, list, n)) {
            return true;
        }
    }
    return false;
}

void hn_other_variant_say(const hn_variant *x, const cJSON *submission, hn_verdict *v) {
    hn_variant_owner owner;
    if (v->n_right == v->n_entries || !find_owner(x, submission, v, &owner)) {
        return;
    }
    const size_t used = strlen(v->summary);
    if (owner.name) {
        snprintf(v->summary + used, sizeof v->summary - used,
                 "; these are the numbers of the variant of '%.60s' (seed %llu), and this is seed "
                 "%llu",
                 owner.name, (unsigned long long)owner.seed, (unsigned long long)x->seed);
    } else {
        snprintf(v->summary + used, sizeof v->summary - used,
                 "; these are the numbers of seed %llu%s, and this is seed %llu",
                 (unsigned long long)owner.seed,
                 owner.seed == x->exercise->seed ? " (the exercise without a name or seed)" : "",
                 (unsigned long long)x->seed);
    }
}
