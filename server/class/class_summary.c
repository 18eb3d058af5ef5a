// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/class_summary.h"

#include "class/class_copies.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { BINS = 10, BAR = 40, MOST_NAMED = 10, MOST_ALIKE = 5, WORD = 96 };

/// Describes how often a word was seen, and who is behind it.
typedef struct count {
    char word[WORD];
    int n;
    hn_strbuf who;
    char first[24]; ///< the texts of the first of them
    bool differs;   ///< another one's texts are others
} count;

typedef struct counts {
    int n, cap;
    count *item;
} counts;

static void add_count(counts *c, const char *word, const char *who) {
    // the place of the word
    int i = 0;
    while (i < c->n && strcmp(c->item[i].word, word) != 0) {
        i++;
    }

    // a new word, in a longer list where that is full
    if (i == c->n) {
        if (c->n == c->cap) {
            const int cap = c->cap ? 2 * c->cap : 32;
            count *larger = realloc(c->item, (size_t)cap * sizeof *larger);
            if (!larger) {
                return;
            }
            c->item = larger;
            c->cap = cap;
        }
        c->item[c->n] = (count){0};
        snprintf(c->item[c->n].word, WORD, "%s", word);
        hn_strbuf_init(&c->item[c->n++].who);
    }

    c->item[i].n++;
    hn_strbuf_printf(&c->item[i].who, "%s%s", c->item[i].n > 1 ? ", " : "", who);
}

static int more_first(const void *a, const void *b) {
    const count *x = a, *y = b;
    return x->n != y->n ? y->n - x->n : strcmp(x->word, y->word);
}

static void sort(counts *c) {
    if (c->n > 0) {
        qsort(c->item, (size_t)c->n, sizeof(count), more_first);
    }
}

static void free_counts(counts *c) {
    for (int i = 0; i < c->n; i++) {
        hn_strbuf_reset(&c->item[i].who);
    }
    free(c->item);
}

static const char *text_of(const cJSON *o, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(o, key));
    return text ? text : "";
}

typedef struct tally {
    int graded, ungradable, failed, bin[BINS + 1];
    double sum, most;
    bool programs; ///< what was handed in
    counts mistakes, equal, like, alike, names;
} tally;

/// Writes who has the same shape: a group counts once two of its texts differ.
static void add_like(counts *c, const cJSON *o, const char *student) {
    const char *shape = text_of(o, "shape"), *texts = text_of(o, "texts");
    const int before = c->n;
    add_count(c, shape, student);
    for (int i = 0; i < c->n; i++) {
        if (strcmp(c->item[i].word, shape) == 0) {
            c->item[i].differs |= c->n == before && strcmp(c->item[i].first, texts) != 0;
            if (c->n > before) {
                snprintf(c->item[i].first, sizeof c->item[i].first, "%s", texts);
            }
        }
    }
}

static void take_line(tally *t, const cJSON *o) {
    const char *student = text_of(o, "student"), *status = text_of(o, "status");

    add_count(&t->names, student, text_of(o, "file"));

    // without a score it is counted only
    if (strcmp(status, "graded") != 0) {
        t->failed += strcmp(status, "failed") == 0;
        t->ungradable += strcmp(status, "ungradable") == 0;
        return;
    }

    // the distribution of the scores
    const double score = cJSON_GetNumberValue(cJSON_GetObjectItem(o, "score"));
    const double most = cJSON_GetNumberValue(cJSON_GetObjectItem(o, "max_score"));
    t->graded++;
    t->sum += score;
    t->most = most;
    t->bin[most > 0 ? (int)(BINS * score / most) : 0]++;

    // mistakes, and answers equal to those of others
    const cJSON *m;
    cJSON_ArrayForEach(m, cJSON_GetObjectItem(o, "mistakes")) {
        add_count(&t->mistakes, m->valuestring, student);
    }
    cJSON_ArrayForEach(m, cJSON_GetObjectItem(o, "alike")) {
        add_count(&t->alike, m->valuestring, student);
    }
    // right formulas are alike by nature; wrong ones are not, and programs are not
    if (score < most || t->programs) {
        add_count(&t->equal, text_of(o, "texts"), student);
        add_like(&t->like, o, student);
    }
}

static void put_histogram(hn_strbuf *b, const tally *t) {
    int highest = 1;
    for (int k = 0; k <= BINS; k++) {
        highest = t->bin[k] > highest ? t->bin[k] : highest;
    }
    for (int k = BINS; k >= 0; k--) {
        char range[24];
        snprintf(range, sizeof range, k == BINS ? "all" : "%d-%d %%", 100 * k / BINS,
                 100 * (k + 1) / BINS);
        const int bar = (BAR * t->bin[k] + highest - 1) / highest;
        hn_strbuf_printf(b, "  %9s %5d  %.*s\n", range, t->bin[k], bar,
                         "########################################");
    }
}

/// Names that more than one submission carries, with their files.
static void put_names(hn_strbuf *b, counts *c) {
    sort(c);
    for (int k = 0; k < c->n && c->item[k].n > 1; k++) {
        hn_strbuf_printf(b, "%s  %s: %s\n",
                         k == 0 ? "more than one submission of a name: keep one\n" : "",
                         c->item[k].word, hn_strbuf_text(&c->item[k].who));
    }
}

/// Groups that differ in their names alone.
static void put_like(hn_strbuf *b, counts *c, bool programs) {
    int shown = 0;
    sort(c);
    for (int k = 0; k < c->n; k++) {
        if (c->item[k].differs) {
            if (shown++ == 0) {
                hn_strbuf_printf(b, "near-copies: %s\n", hn_class_copies_near(programs));
            }
            hn_strbuf_printf(b, "  %s\n", hn_strbuf_text(&c->item[k].who));
        }
    }
}

/// Pairs of programs that share most of their statements.
static void put_programs_alike(hn_strbuf *b, const hn_class_result *r, bool programs) {
    if (programs) {
        hn_class_copies copies;
        hn_class_copies_find(&copies, r, true);
        hn_class_copies_put_alike(b, &copies);
        hn_class_copies_reset(&copies);
    }
}

/// Returns whether equal wrong answers to a part are worth a look: a known mistake that many make
/// is none.
static bool is_alike(const count *c) {
    return c->n > 1 && (c->n <= MOST_ALIKE || strstr(c->word, ": other "));
}

/// Wrong answers to one part that are equal.
static void put_alike(hn_strbuf *b, counts *c) {
    int shown = 0;
    sort(c);
    for (int k = 0; k < c->n; k++) {
        const char *word = c->item[k].word, *hash = strrchr(word, ' ');
        if (is_alike(&c->item[k]) && hash) {
            const char *mistake = strstr(word, ": ") + 2;
            hn_strbuf_printf(b, "%s  %.*s %s (%.*s)\n",
                             shown++ ? ""
                                     : "equal wrong parts (formulas with each variant's numbers "
                                       "replaced by their names;\nplain numbers of 4 digits or "
                                       "more within one variant alone: another has another "
                                       "answer)\n",
                             (int)(mistake - word - 1), word, hn_strbuf_text(&c->item[k].who),
                             (int)(hash - mistake), mistake);
        }
    }
}

void hn_class_summary(hn_strbuf *b, const hn_class_result *r, bool programs) {
    tally t = {.programs = programs};
    for (int i = 0; i < r->n; i++) {
        cJSON *o = r->line[i] ? cJSON_Parse(r->line[i]) : NULL;
        if (o) {
            take_line(&t, o);
        }
        cJSON_Delete(o);
    }
    const int n = r->n - r->others;
    hn_strbuf_printf(b, "%d submission%s: %d graded, %d not gradable, %d failed in the grader\n", n,
                     n == 1 ? "" : "s", t.graded, t.ungradable, t.failed);
    if (t.graded > 0) {
        hn_strbuf_printf(b, "mean of the %d graded: %.2f of %g\n", t.graded, t.sum / t.graded,
                         t.most);
        put_histogram(b, &t);
    }

    // what to talk about in class
    sort(&t.mistakes);
    for (int k = 0; k < t.mistakes.n && k < MOST_NAMED; k++) {
        hn_strbuf_printf(b, "%s  %4d  %s\n", k == 0 ? "commonest mistakes\n" : "",
                         t.mistakes.item[k].n, t.mistakes.item[k].word);
    }
    sort(&t.equal);
    for (int k = 0; k < t.equal.n && t.equal.item[k].n > 1; k++) {
        hn_strbuf_printf(b, "%s  %s\n",
                         k > 0      ? ""
                         : programs ? "equal programs, blanks, capitals and comments aside\n"
                                    : "equal wrong answers, blanks and capitals aside\n",
                         hn_strbuf_text(&t.equal.item[k].who));
    }
    put_like(b, &t.like, programs);
    put_programs_alike(b, r, programs);
    put_alike(b, &t.alike);
    put_names(b, &t.names);
    free_counts(&t.names);
    free_counts(&t.mistakes);
    free_counts(&t.equal);
    free_counts(&t.like);
    free_counts(&t.alike);
}
