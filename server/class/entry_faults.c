// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/entry_faults.h"

#include <math.h>
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

/// The faults of a term stand behind those of the whole; two of them are a bit of hn_entry_faults.
enum { N_FAULTS = sizeof FAULTS / sizeof *FAULTS, OF_TERM = 7, MOST_SAID = 3 };
_Static_assert((N_FAULTS - OF_TERM) * (N_FAULTS - OF_TERM) <= 64, "a bit for any two faults");
/// Two faults in one entry leave less than either does, a factor that nobody knows as little.
static const double SHARE_OF_FACTOR = 0.25;
static const double EQUAL_FACTORS = 1e-8; // relative

static int bit_of_two(int a, int b) {
    return (a - OF_TERM) * (N_FAULTS - OF_TERM) + b - OF_TERM;
}

static bool is_possible(const hn_entry_values *entry, int f) {
    return !FAULTS[f].of_mass || entry->is_mass;
}

/// Whether the entry with `change` added at each state is what was given.
static bool is_given(const hn_entry_values *entry, const double *change) {
    for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
        if (!(fabs(entry->given[k] - entry->right[k] - change[k]) <= entry->allowed)) {
            return false;
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

static void find_one(const hn_entry_values *entry, hn_entry_faults *out) {
    for (int f = 0; f < N_FAULTS; f++) {
        const int terms = f < OF_TERM ? 0 : out->terms > 1 ? out->terms : -1;
        for (int m = f < OF_TERM ? -1 : 0; m < terms && is_possible(entry, f); m++) {
            double change[HN_EXPORT_EXAM_STATES] = {0};
            add_change(entry, f, m, change);
            if (is_given(entry, change)) {
                out->one |= 1ULL << f;
            }
        }
    }
}

/// Whether faults a and b at two different terms explain the entry.
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
    for (int a = OF_TERM; a < N_FAULTS && out->terms > 1; a++) {
        for (int b = a; b < N_FAULTS; b++) {
            if (is_possible(entry, a) && is_possible(entry, b) && are_both(entry, a, b)) {
                out->two |= 1ULL << bit_of_two(a, b);
            }
        }
    }
}

/// Names two parameters of one unit whose ratio is the factor, where these are the only ones.
static void name_factor(const hn_scene *scene, hn_entry_faults *out) {
    int found = 0;
    for (int i = 0; i < scene->n_params; i++) {
        for (int k = 0; k < scene->n_params; k++) {
            const hn_param *wrong = &scene->params[i], *right = &scene->params[k];
            if (i != k && wrong->value != right->value && wrong->unit && right->unit &&
                strcmp(wrong->unit, right->unit) == 0 &&
                fabs(wrong->value - out->factor * right->value) <=
                    EQUAL_FACTORS * fabs(wrong->value)) {
                found++;
                snprintf(out->instead, sizeof out->instead, "%.40s in place of %.40s", wrong->name,
                         right->name);
            }
        }
    }
    if (found != 1) {
        out->instead[0] = '\0';
    }
}

/// The factor of the one term that explains the entry, in an entry that moves: in a constant one
/// any term would do.
static void find_factor(const hn_entry_values *entry, hn_entry_faults *out) {
    int found = 0;
    for (int m = 0; m < out->terms && out->terms > 1; m++) {
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
            out->factor = 1 + above / below;
        }
    }
    if (found != 1) {
        out->factor = 0;
    } else {
        name_factor(entry->scene, out);
    }
}

hn_entry_faults hn_entry_faults_find(const hn_entry_values *entry) {
    hn_entry_faults out = {.terms = entry->sum->n};
    find_one(entry, &out);
    if (!out.one) {
        find_factor(entry, &out);
    }
    if (!out.one && out.factor == 0) {
        find_two(entry, &out);
    }
    return out;
}

double hn_entry_faults_share(const hn_entry_faults *faults) {
    double share = faults->factor != 0 ? SHARE_OF_FACTOR : 1;
    bool any = faults->factor != 0;
    for (int f = 0; f < N_FAULTS; f++) {
        if (faults->one & 1ULL << f) {
            share = fmin(share, FAULTS[f].share);
            any = true;
        }
    }
    for (int a = OF_TERM; a < N_FAULTS; a++) {
        for (int b = a; b < N_FAULTS; b++) {
            if (faults->two & 1ULL << bit_of_two(a, b)) {
                share = fmin(share, FAULTS[a].share * FAULTS[b].share);
                any = true;
            }
        }
    }
    return any ? share : 0;
}

const char *hn_entry_faults_id(const hn_entry_faults *faults) {
    for (int f = 0; f < N_FAULTS; f++) {
        if ((faults->one & 1ULL << f) && FAULTS[f].share == hn_entry_faults_share(faults)) {
            return FAULTS[f].id;
        }
    }
    return faults->instead[0]    ? "other-name"
           : faults->factor != 0 ? "factor-term"
           : faults->two         ? "two-terms"
                                 : "";
}

static int count_bits(uint64_t bits) {
    int n = 0;
    for (; bits; bits &= bits - 1) {
        n++;
    }
    return n;
}

void hn_entry_faults_put(hn_strbuf *b, const hn_entry_faults *faults) {
    int said = 0;
    for (int f = 0; f < N_FAULTS; f++) {
        if (!(faults->one & 1ULL << f) || said == MOST_SAID) {
            continue;
        }
        hn_strbuf_add(b, said++ > 0 ? ", or " : "");
        if (FAULTS[f].of_term) {
            hn_strbuf_printf(b, "one of its %d terms ", faults->terms);
        }
        hn_strbuf_add(b, FAULTS[f].says);
    }
    for (int a = OF_TERM; a < N_FAULTS; a++) {
        for (int k = a; k < N_FAULTS; k++) {
            if ((faults->two & 1ULL << bit_of_two(a, k)) && said < MOST_SAID) {
                hn_strbuf_printf(b, "%sone of its %d terms %s and another one %s",
                                 said++ > 0 ? ", or " : "", faults->terms, FAULTS[a].says,
                                 FAULTS[k].says);
            }
        }
    }
    if (count_bits(faults->one) + count_bits(faults->two) > said) {
        hn_strbuf_add(b, ", or others");
    }
    if (faults->factor != 0) {
        hn_strbuf_printf(b, "one of its %d terms is %.4g times the right one%s%s", faults->terms,
                         faults->factor, faults->instead[0] ? ", as " : "", faults->instead);
    }
}
