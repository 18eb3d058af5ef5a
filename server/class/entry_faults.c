// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/entry_faults.h"

#include "base/hash.h"
#include "session/export/exam_changes.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// Faults of a whole entry and of a term: the right value times a factor.
static const struct fault {
    const char *id, *says;
    bool of_term, of_mass; ///< of_mass: only in the mass matrix
    double factor, share;
} FAULTS[] = {
    {"sign", "its sign is wrong", false, false, -1, 0.5},
    {"factor", "a factor 2 is missing", false, false, 0.5, 0.25},
    {"factor", "a factor 1/2 is missing", false, false, 2, 0.25},
    {"inertia", "it is 1/4 of the right one, as m l^2/12 (about the centre) in place of m l^2/3",
     false, true, 0.25, 0.25},
    {"inertia", "it is 4 times the right one, as m l^2/3 (about the end) in place of m l^2/12",
     false, true, 4, 0.25},
    {"inertia", "it is 3/4 of the right one, as m l^2/4 (a point mass) in place of m l^2/3", false,
     true, 0.75, 0.25},
    {"inertia", "it is 3 times the right one, as m l^2 (a point mass) in place of m l^2/3", false,
     true, 3, 0.25},
    {"sign-term", "has the wrong sign", true, false, -1, 0.5},
    {"missing-term", "is missing", true, false, 0, 0.25},
    {"factor-term", "lacks a factor 2", true, false, 0.5, 0.25},
    {"factor-term", "lacks a factor 1/2", true, false, 2, 0.25},
    {"inertia-term", "is 1/4 of the right one, as m l^2/12 (about the centre) in place of m l^2/3",
     true, true, 0.25, 0.25},
    {"inertia-term", "is 4 times the right one, as m l^2/3 (about the end) in place of m l^2/12",
     true, true, 4, 0.25},
    {"inertia-term", "is 3/4 of the right one, as m l^2/4 (a point mass) in place of m l^2/3", true,
     true, 0.75, 0.25},
    {"inertia-term", "is 3 times the right one, as m l^2 (a point mass) in place of m l^2/3", true,
     true, 3, 0.25}};

/// The faults of a term stand behind those of the whole.
enum { N_FAULTS = sizeof FAULTS / sizeof *FAULTS, OF_TERM = 7, MOST_SAID = 3, MOST_CHANGES = 200 };
/// Credit left by an unknown factor, and tolerance for another name.
static const double SHARE_OF_FACTOR = 0.25;
static const double EQUAL_FACTORS = 1e-8; // relative

/// Keeps an explanation; one that says the same is the same.
static void HN_PRINTF(5, 6) keep(hn_entry_faults *out, const char *id, double share, uint64_t key,
                                 const char *format, ...) {
    char says[HN_ENTRY_FAULT_TEXT];
    va_list args;
    va_start(args, format);
    vsnprintf(says, sizeof says, format, args);
    va_end(args);
    for (int i = 0; i < out->n; i++) {
        if (strcmp(out->fault[i].says, says) == 0) {
            return;
        }
    }

    out->share = out->found++ == 0 ? share : fmin(out->share, share);
    if (out->n < HN_ENTRY_FAULTS) {
        struct hn_entry_fault *fault = &out->fault[out->n++];
        *fault = (struct hn_entry_fault){.id = id, .share = share, .key = key};
        memcpy(fault->says, says, sizeof says);
    }
}

static bool is_possible(const hn_entry_values *entry, int f, const hn_entry_faults *out) {
    // the missing terms of a parameter have been named by it
    const bool is_named = FAULTS[f].factor == 0 && out->n > 0;
    return !is_named && (!FAULTS[f].of_mass || entry->part == HN_EXPORT_MASS);
}

/// Returns whether the entry with `change` added at each state is what was given.
static bool is_given(const hn_entry_values *entry, const double *change) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        if (!(fabs(entry->given[k] - entry->right[k] - change[k]) <= entry->allowed)) {
            return false;
        }
    }
    return true;
}

/// Returns whether no term moves: two faults in two of them then explain a wrong number by chance.
static bool is_constant(const hn_entry_values *entry) {
    for (int m = 0; m < entry->sum->n; m++) {
        for (int k = 1; k < HN_EXPORT_EXAM_STATES; k++) {
            if (fabs(entry->sum->t[m][k] - entry->sum->t[m][0]) > entry->allowed) {
                return false;
            }
        }
    }
    return true;
}

/// Adds what fault f at term m changes; m = -1: at the whole.
static void add_change(const hn_entry_values *entry, int f, int m, double *change) {
    const double *of = m < 0 ? entry->right : entry->sum->t[m];
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        change[k] += (FAULTS[f].factor - 1) * of[k];
    }
}

static void keep_one(int f, hn_entry_faults *out) {
    const uint64_t key = hn_hash_word(HN_HASH_START, (uint64_t)f);
    char where[40] = "";
    if (f >= OF_TERM) {
        snprintf(where, sizeof where, "one of its %d terms ", out->terms);
    }
    keep(out, FAULTS[f].id, FAULTS[f].share, key, "%s%s", where, FAULTS[f].says);
}

static void find_one(const hn_entry_values *entry, hn_entry_faults *out) {
    const hn_entry_faults before = *out;
    for (int f = 0; f < N_FAULTS; f++) {
        const int terms = f < OF_TERM ? 0 : out->terms > 1 ? out->terms : -1;
        for (int m = f < OF_TERM ? -1 : 0; m < terms && is_possible(entry, f, &before); m++) {
            double change[HN_EXPORT_EXAM_STATES] = {0};
            add_change(entry, f, m, change);
            if (is_given(entry, change)) {
                keep_one(f, out);
            }
        }
    }
}

/// Returns whether faults a and b at two different terms explain the entry.
static bool are_both(const hn_entry_values *entry, int a, int b) {
    for (int m = 0; m < entry->sum->n; m++) {
        for (int i = 0; i < entry->sum->n; i++) {
            double change[HN_EXPORT_EXAM_STATES] = {0};
            add_change(entry, a, m, change);
            add_change(entry, b, i, change);
            if (i != m && is_given(entry, change)) {
                return true;
            }
        }
    }
    return false;
}

static void find_two(const hn_entry_values *entry, hn_entry_faults *out) {
    const hn_entry_faults before = *out;
    for (int a = OF_TERM; a < N_FAULTS && out->terms > 1; a++) {
        for (int b = a; b < N_FAULTS; b++) {
            if (is_possible(entry, a, &before) && is_possible(entry, b, &before) &&
                are_both(entry, a, b)) {
                const uint64_t pair = (uint64_t)(N_FAULTS * (a + 1) + b);
                keep(out, "two-terms", FAULTS[a].share * FAULTS[b].share,
                     hn_hash_word(HN_HASH_START, pair), "one of its %d terms %s and another one %s",
                     out->terms, FAULTS[a].says, FAULTS[b].says);
            }
        }
    }
}

/// Names two parameters of one unit whose ratio is the factor, where these are the only ones.
static void name_factor(const hn_scene *scene, double factor, char instead[112]) {
    int found = 0;
    for (int i = 0; i < scene->n_params; i++) {
        for (int k = 0; k < scene->n_params; k++) {
            const hn_param *wrong = &scene->params[i], *right = &scene->params[k];
            if (i != k && wrong->value != right->value && wrong->unit && right->unit &&
                strcmp(wrong->unit, right->unit) == 0 &&
                fabs(wrong->value - factor * right->value) <= EQUAL_FACTORS * fabs(wrong->value)) {
                found++;
                snprintf(instead, 112, ", as %.40s in place of %.40s", wrong->name, right->name);
            }
        }
    }
    if (found != 1) {
        instead[0] = '\0';
    }
}

/// The factor of the one term that explains the entry, in an entry that moves: in a constant one
/// any term would do. An entry of one term is that term.
static void find_factor(const hn_entry_values *entry, hn_entry_faults *out) {
    int found = 0;
    double factor = 0;
    for (int m = 0; m < out->terms; m++) {
        double above = 0, below = 0, least = HUGE_VAL, most = -HUGE_VAL;
        for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
            const double term = entry->sum->t[m][k];
            above += (entry->given[k] - entry->right[k]) * term;
            below += term * term;
            least = fmin(least, term);
            most = fmax(most, term);
        }
        double change[HN_EXPORT_EXAM_STATES];
        for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
            change[k] = below > 0 ? above / below * entry->sum->t[m][k] : 0;
        }
        if (most - least > entry->allowed && is_given(entry, change)) {
            found++;
            factor = 1 + above / below;
        }
    }
    if (found == 1) {
        char instead[112] = "", where[40] = "it";
        if (out->terms > 1) {
            snprintf(where, sizeof where, "one of its %d terms", out->terms);
        }
        name_factor(entry->scene, factor, instead);
        keep(out, instead[0] ? "other-name" : "factor-term", SHARE_OF_FACTOR,
             hn_hash_text(hn_hash_double(HN_HASH_START, factor), instead),
             "%s is %.4g times the right one%s", where, factor, instead);
    }
}

// ---- a symbol in place of another ----

/// Result of a change of an entry.
typedef struct changed {
    hn_exam_change change;
    double whole[HN_EXPORT_EXAM_STATES];
    hn_export_sum terms;
} changed;

/// Returns whether the whole entry, times the sign, is what the change makes of it.
static bool is_whole(const hn_entry_values *entry, const changed *c, double sign) {
    double change[HN_EXPORT_EXAM_STATES];
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        change[k] = sign * c->whole[k] - entry->right[k];
    }
    return is_given(entry, change);
}

/// Returns whether one term of several, times the sign, is what the change makes of it.
static bool is_term(const hn_entry_values *entry, const changed *c, double sign) {
    for (int m = 0; m < entry->sum->n && entry->sum->n > 1; m++) {
        double change[HN_EXPORT_EXAM_STATES];
        for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
            change[k] = sign * c->terms.t[m][k] - entry->sum->t[m][k];
        }
        if (is_given(entry, change)) {
            return true;
        }
    }
    return false;
}

static void keep_change(const hn_entry_values *entry, const changed *c, bool whole,
                        hn_entry_faults *out) {
    const hn_exam_change *change = &c->change;
    const char *from = change->from < 0 ? "" : hn_exam_symbol_name(entry->exam, change->from);
    const char *to = change->to < 0 ? "" : hn_exam_symbol_name(entry->exam, change->to);
    char where[40] = "it";
    uint64_t key = hn_hash_word(HN_HASH_START, 1000 + (uint64_t)change->kind);
    key = hn_hash_text(hn_hash_text(key, from), to);
    if (!whole) {
        snprintf(where, sizeof where, "one of its %d terms", out->terms);
    }

    // the same words for a name that is wrong everywhere and at one place
    const double share = SHARE_OF_FACTOR;
    switch (change->kind) {
    case HN_CHANGE_NAME:
    case HN_CHANGE_ONE:
        keep(out, "other-coordinate", share, key, "%s has %.30s in place of %.30s", where, to,
             from);
        break;
    case HN_CHANGE_POWER:
        keep(out, "power", share, key, "%s lacks a factor %.30s", where, from);
        break;
    case HN_CHANGE_SUM:
        keep(out, "angle-origin", share, key,
             "%s has %.30s + %.30s in place of %.30s, as if that were counted from %.30s", where,
             to, from, from, to);
        break;
    case HN_CHANGE_DIFFERENCE:
        keep(out, "angle-origin", share, key,
             "%s has %.30s - %.30s in place of %.30s, as if that included %.30s", where, from, to,
             from, to);
        break;
    case HN_CHANGE_QUARTER:
        keep(out, "sine-cosine", share, key, "%s has sine and cosine exchanged", where);
        break;
    case HN_CHANGE_WITHOUT:
        keep(out, "missing-term", share, key, "all terms with %.30s are missing", from);
        break;
    case HN_CHANGE_DEGREES:
        keep(out, "degrees", share, key, "its angles count as degrees, and they are in radians");
        break;
    case HN_CHANGE_RADIANS:
        keep(out, "degrees", share, key, "its angles are converted to radians, which they are in");
        break;
    }
}

/// Explanations by a symbol: those by a parameter whose terms are missing, or the others.
static void find_changes(const hn_entry_values *entry, bool missing, hn_entry_faults *out) {
    hn_exam_change list[MOST_CHANGES];
    const int n = hn_exam_changes_list(entry->exam, entry->part, entry->i, list, MOST_CHANGES);
    for (int i = 0; i < n; i++) {
        changed c = {.change = list[i]};
        if ((list[i].kind == HN_CHANGE_WITHOUT) != missing ||
            hn_exam_change_apply(entry->exam, entry->part, entry->i, &list[i], c.whole, &c.terms) !=
                HN_OK) {
            continue;
        }
        const bool of_term = list[i].kind < HN_CHANGE_WITHOUT;
        const bool turns = list[i].kind == HN_CHANGE_QUARTER;
        if (is_whole(entry, &c, 1) || (turns && is_whole(entry, &c, -1))) {
            keep_change(entry, &c, true, out);
        } else if (of_term && (is_term(entry, &c, 1) || (turns && is_term(entry, &c, -1)))) {
            keep_change(entry, &c, false, out);
        }
    }
}

hn_entry_faults hn_entry_faults_find(const hn_entry_values *entry) {
    hn_entry_faults out = {.terms = entry->sum->n};
    const bool moves = !is_constant(entry);
    if (entry->thorough) {
        find_changes(entry, true, &out);
    }
    find_one(entry, &out);
    if (out.found == 0 && moves) {
        find_factor(entry, &out);
    }
    if (out.found == 0 && entry->thorough) {
        find_changes(entry, false, &out);
    }
    if (out.found == 0 && moves) {
        find_two(entry, &out);
    }
    return out;
}

// ---- several explanations ----

/// Returns how many of the entries a fault explains.
static int count_entries(const hn_entry_faults *all, int n, uint64_t key) {
    int count = 0;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < all[i].n; k++) {
            count += all[i].fault[k].key == key;
        }
    }
    return count;
}

/// Sorts by insertion: of equal ones the first stays in front.
static void rank_entry(hn_entry_faults *e) {
    for (int k = 1; k < e->n; k++) {
        const struct hn_entry_fault one = e->fault[k];
        int at = k;
        for (; at > 0 && e->fault[at - 1].entries < one.entries; at--) {
            e->fault[at] = e->fault[at - 1];
        }
        e->fault[at] = one;
    }
    if (e->n > 1 && e->fault[0].entries > 1 && e->fault[0].entries > e->fault[1].entries) {
        e->n = e->found = 1;
        e->share = e->fault[0].share;
    }
}

void hn_entry_faults_rank(hn_entry_faults *all, int n) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < all[i].n; k++) {
            all[i].fault[k].entries = count_entries(all, n, all[i].fault[k].key);
        }
    }
    for (int i = 0; i < n; i++) {
        rank_entry(&all[i]);
    }
}

const char *hn_entry_faults_id(const hn_entry_faults *faults) {
    for (int i = 0; i < faults->n; i++) {
        if (faults->fault[i].share == faults->share) {
            return faults->fault[i].id;
        }
    }
    return faults->n > 0 ? faults->fault[0].id : "";
}

/// The first so many explanations.
static void put_first(hn_strbuf *b, const hn_entry_faults *faults, int n) {
    for (int i = 0; i < n; i++) {
        hn_strbuf_printf(b, "%s%s", i > 0 ? ", or " : "", faults->fault[i].says);
    }
    hn_strbuf_add(b, faults->found > n ? ", or others" : "");
}

void hn_entry_faults_put(hn_strbuf *b, const hn_entry_faults *faults, int room) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    for (int n = faults->n < MOST_SAID ? faults->n : MOST_SAID; n > 0; n--) {
        hn_strbuf_clear(&text);
        put_first(&text, faults, n);
        if (n == 1 || (int)text.n <= room) {
            break;
        }
    }
    hn_strbuf_add(b, hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}
