// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/other_variant.h"

#include "base/hash.h"
#include "grade/parts/part_list.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum {
    SMALL_SEEDS = 8,
    SPELLINGS = 3,
    LONGEST_NAME = 128,
    LEAST = 2,
    MAX_WRONG = 16,
    BYSTANDERS = 100
};

/// Two numbers that no bystander shares are below it, (1 / 101)^2; one such number beside one of a
/// hundred small counts is not.
static const double MOST_CHANCE = 3e-4;

/// A number that is wrong in this variant.
typedef struct wrong_number {
    int part, result; ///< of the exercise; among the results of the part
} wrong_number;

/// Returns whether the answers of a part are numbers, which differ from variant to variant.
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

/// Finds which of the wrong numbers are right in the variant of this seed; false: it cannot be
/// drawn.
static bool try_variant(const hn_exercise *exercise, uint64_t seed, const cJSON *submission,
                        const wrong_number *list, int n, bool right[MAX_WRONG]) {
    hn_variant other;
    hn_diag diag = {0};
    bool good = hn_variant_init(&other, exercise, seed, &diag) == HN_OK;
    for (int i = 0; i < n && good; i++) {
        hn_part_result results[HN_PART_RESULTS];
        int count = 0;
        const hn_part *p = &other.part[list[i].part];
        good = p->kind->grade(p, cJSON_GetObjectItemCaseSensitive(submission, p->id), results,
                              &count, &diag) == HN_OK;
        right[i] = good && list[i].result < count && results[list[i].result].right;
    }
    hn_variant_reset(&other);
    return good;
}

/// The probability that the numbers which fit do so by chance: for each, the share of variants of
/// nobody in which it is right as well. Small counts, and ratios of listed numbers, are shared by
/// many variants.
static double find_chance(const hn_exercise *exercise, const cJSON *submission,
                          const wrong_number *list, int n, const bool fits[MAX_WRONG]) {
    int hits[MAX_WRONG] = {0}, tried = 0;
    double chance = 1;
    for (int k = 0; k < BYSTANDERS && !hn_interrupt_ask(&exercise->interrupt); k++) {
        bool right[MAX_WRONG];
        const uint64_t seed = hn_hash_bytes(HN_HASH_START, &k, sizeof k);
        if (try_variant(exercise, seed, submission, list, n, right)) {
            tried++;
            for (int i = 0; i < n; i++) {
                hits[i] += right[i];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        chance *= fits[i] ? (double)(1 + hits[i]) / (double)(1 + tried) : 1;
    }
    return chance;
}

/// Returns how many of the wrong numbers are those of this seed; 0 where too few are, or by chance.
static int count_fits(const hn_exercise *exercise, uint64_t seed, const cJSON *submission,
                      const wrong_number *list, int n) {
    bool right[MAX_WRONG];
    int count = 0;
    if (!try_variant(exercise, seed, submission, list, n, right)) {
        return 0;
    }
    for (int i = 0; i < n; i++) {
        count += right[i];
    }
    const bool enough = count >= LEAST && n - count < 2;
    return enough && find_chance(exercise, submission, list, n, right) <= MOST_CHANCE ? count : 0;
}

/// The name with other capitals, of ASCII letters: "Ada Lovelace", "ada lovelace", "ADA LOVELACE".
static void respell(const char *name, int way, char out[LONGEST_NAME]) {
    bool begins = true;
    size_t n = 0;
    for (; name[n] && n < LONGEST_NAME - 1; n++) {
        const unsigned char c = (unsigned char)name[n];
        out[n] = (char)(way == 2 || (way == 0 && begins) ? toupper(c) : tolower(c));
        begins = c == ' ' || c == '-';
    }
    out[n] = 0;
}

/// Returns who submitted: the name in the file, else the one whose variant this is; "": nobody is
/// named.
static const char *student_of(const hn_variant *x, const hn_verdict *v) {
    const char *name = v->student;
    for (int i = 0; i < x->exercise->n_owners && !name[0]; i++) {
        const hn_variant_owner *owner = &x->exercise->owners[i];
        name = owner->seed == x->seed && owner->name ? owner->name : name;
    }
    return name;
}

/// Returns whose numbers they may be: the owner i of the exercise, then the student with other
/// capitals (written to `spelt`), then a few small seeds.
static hn_variant_owner candidate_at(const hn_variant *x, const char *student, int i,
                                     char spelt[LONGEST_NAME]) {
    const hn_exercise *e = x->exercise;
    if (i < e->n_owners) {
        return e->owners[i];
    }
    i -= e->n_owners;
    if (i < SPELLINGS) {
        respell(student, i, spelt);
        return (hn_variant_owner){.name = spelt,
                                  .seed = student[0] ? hn_variant_seed(e, spelt) : x->seed};
    }
    return (hn_variant_owner){.seed = (uint64_t)(i - SPELLINGS + 1)};
}

/// Looks for the variant among the candidates; writes how many numbers are wrong, and returns how
/// many of them are its numbers.
static int find_owner(const hn_variant *x, const cJSON *submission, const hn_verdict *v,
                      char spelt[LONGEST_NAME], hn_variant_owner *out, int *n) {
    const hn_exercise *e = x->exercise;
    wrong_number list[MAX_WRONG];
    *n = list_wrong(x, v, list);
    for (int i = 0; i < e->n_owners + SPELLINGS + SMALL_SEEDS && *n >= LEAST; i++) {
        *out = candidate_at(x, student_of(x, v), i, spelt);
        const int fits = out->seed == x->seed ? 0 : count_fits(e, out->seed, submission, list, *n);
        if (fits > 0) {
            return fits;
        }
    }
    return 0;
}

void hn_other_variant_say(const hn_variant *x, const cJSON *submission, hn_verdict *v) {
    hn_variant_owner owner;
    char spelt[LONGEST_NAME];
    int n = 0;
    const int fits =
        v->n_right == v->n_entries ? 0 : find_owner(x, submission, v, spelt, &owner, &n);
    if (fits == 0) {
        return;
    }

    size_t used = strlen(v->summary);
    used += (size_t)snprintf(v->summary + used, sizeof v->summary - used,
                             "; %d of the %d wrong numbers agree with the numbers of ", fits, n);
    if (used < sizeof v->summary && owner.name) {
        snprintf(v->summary + used, sizeof v->summary - used,
                 "the variant of '%.60s' (seed %llu), and this is seed %llu%s", owner.name,
                 (unsigned long long)owner.seed, (unsigned long long)x->seed,
                 owner.name == spelt ? ": capital letters in a name count" : "");
    } else if (used < sizeof v->summary) {
        snprintf(v->summary + used, sizeof v->summary - used, "seed %llu%s, and this is seed %llu",
                 (unsigned long long)owner.seed,
                 owner.seed == x->exercise->seed ? " (the exercise without a name or seed)" : "",
                 (unsigned long long)x->seed);
    }
}
