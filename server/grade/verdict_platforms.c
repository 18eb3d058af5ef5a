// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/verdict_platforms.h"

#include "base/base64.h"
#include "grade/verdict_reports.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

enum { PRAIRIELEARN_BYTES = 1000000 };

static bool is_graded(const hn_verdict *v) {
    return v->kind == HN_VERDICT_GRADED;
}

/// The share of all points, from 0 to 1.
static double share_of(const hn_verdict *v) {
    return v->max_score > 0 ? v->score / v->max_score : 0;
}

/// Writes what is to be said on the whole: the summary and the note, or the reason and the hint.
static void put_message(hn_strbuf *b, const hn_verdict *v, const char *key) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_strbuf_add(&text, is_graded(v) ? v->summary : v->reason);
    const char *more = is_graded(v) ? v->note : v->hint;
    hn_strbuf_printf(&text, "%s%s", more[0] ? ". " : "", more);
    hn_json_put_string(b, key, hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

// ---- PrairieLearn ----

static void put_picture(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png) {
    hn_strbuf url;
    if (!png || png->n == 0 || b->n + png->n / 3 * 4 > PRAIRIELEARN_BYTES) {
        return;
    }
    hn_strbuf_init(&url);
    hn_strbuf_add(&url, "data:image/png;base64,");
    hn_base64(&url, hn_strbuf_text(png), png->n);
    hn_json_key(b, "images");
    hn_json_array(b);
    hn_json_object(b);
    hn_json_put_string(b, "label", v->entry[v->shown_entry].name);
    hn_json_put_string(b, "url", hn_strbuf_text(&url));
    hn_json_end_object(b);
    hn_json_end_array(b);
    b->failed |= url.failed;
    hn_strbuf_reset(&url);
}

static void put_tests(hn_strbuf *b, const hn_verdict *v) {
    hn_json_key(b, "tests");
    hn_json_array(b);
    for (int k = 0; k < v->n_entries; k++) {
        const hn_entry_verdict *e = &v->entry[k];
        hn_strbuf detail;
        hn_strbuf_init(&detail);
        hn_verdict_entry_text(&detail, v, e, "");
        hn_json_object(b);
        hn_json_put_string(b, "name", e->name);
        hn_json_put_number(b, "points", e->points);
        hn_json_put_number(b, "max_points", e->max_points);
        hn_json_put_string(b, "message", e->right ? "right" : e->mistake);
        hn_json_put_string(b, "output", hn_strbuf_text(&detail));
        hn_json_end_object(b);
        b->failed |= detail.failed;
        hn_strbuf_reset(&detail);
    }
    hn_json_end_array(b);
}

void hn_verdict_prairielearn(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png) {
    hn_json_object(b);
    hn_json_put_bool(b, "gradable", is_graded(v));
    if (is_graded(v)) {
        hn_json_put_number(b, "score", share_of(v));
        put_message(b, v, "message");
        put_tests(b, v);
        put_picture(b, v, png);
    } else {
        hn_json_key(b, "format_errors");
        hn_json_array(b);
        hn_json_string(b, v->reason);
        if (v->hint[0]) {
            hn_json_string(b, v->hint);
        }
        hn_json_end_array(b);
    }
    hn_json_end_object(b);
}

// ---- Autolab ----

/// Length of the part's id in the name of an entry: "b" in "b.2".
static int part_length(const hn_entry_verdict *e) {
    return (int)strcspn(e->name, ".");
}

static bool same_part(const hn_entry_verdict *a, const hn_entry_verdict *b) {
    return part_length(a) == part_length(b) &&
           strncmp(a->name, b->name, (size_t)part_length(a)) == 0;
}

/// Calls `put` once for each part of the exercise with its points; its entries stand together.
static void each_part(hn_strbuf *b, const hn_verdict *v,
                      void (*put)(hn_strbuf *b, const hn_verdict *v, const char *name, int first,
                                  int last)) {
    if (!v->problem->n_parts) {
        put(b, v, v->problem->id, 0, v->n_entries);
        return;
    }
    for (int i = 0; i < v->problem->n_parts && !is_graded(v); i++) {
        put(b, v, v->problem->parts[i].id, 0, 0);
    }
    for (int k = 0, last; k < v->n_entries && is_graded(v); k = last) {
        char name[32];
        for (last = k + 1; last < v->n_entries && same_part(&v->entry[k], &v->entry[last]);) {
            last++;
        }
        snprintf(name, sizeof name, "%.*s", part_length(&v->entry[k]), v->entry[k].name);
        put(b, v, name, k, last);
    }
}

static void put_score(hn_strbuf *b, const hn_verdict *v, const char *name, int first, int last) {
    double points = 0;
    for (int k = first; k < last && is_graded(v); k++) {
        points += v->entry[k].points;
    }
    hn_json_put_number(b, name, points);
}

static void put_case(hn_strbuf *b, const hn_verdict *v, const char *name, int first, int last) {
    bool passed = is_graded(v);
    const char *hint = passed ? "" : v->reason;
    for (int k = last - 1; k >= first; k--) {
        passed &= v->entry[k].points >= v->entry[k].max_points;
        hint = is_graded(v) && !v->entry[k].right ? v->entry[k].explanation : hint;
    }
    hn_json_key(b, name);
    hn_json_object(b);
    hn_json_put_bool(b, "passed", passed);
    if (!passed) {
        hn_json_put_string(b, "hint", hint);
    }
    hn_json_end_object(b);
}

void hn_verdict_autolab(hn_strbuf *b, const hn_verdict *v) {
    hn_json_object(b);
    hn_json_put_string(b, "_presentation", "semantic");
    hn_json_key(b, "stages");
    hn_json_array(b);
    hn_json_string(b, "Grade");
    hn_json_end_array(b);
    hn_json_key(b, "Grade");
    hn_json_object(b);
    each_part(b, v, put_case);
    hn_json_end_object(b);
    hn_json_end_object(b);
    hn_strbuf_add(b, "\n");

    // the last line is what counts
    hn_strbuf scores;
    hn_strbuf_init(&scores);
    hn_json_object(&scores);
    hn_json_key(&scores, "scores");
    hn_json_object(&scores);
    each_part(&scores, v, put_score);
    hn_json_end_object(&scores);
    hn_json_end_object(&scores);
    hn_strbuf_printf(b, "%s\n", hn_strbuf_text(&scores));
    b->failed |= scores.failed;
    hn_strbuf_reset(&scores);
}

// ---- CodeRunner ----

static void put_row(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e) {
    char points[48];
    hn_strbuf detail;
    hn_strbuf_init(&detail);
    hn_verdict_entry_text(&detail, v, e, "");
    snprintf(points, sizeof points, "%g / %g", e->points, e->max_points);
    hn_json_array(b);
    hn_json_bool(b, e->points >= e->max_points);
    hn_json_string(b, e->name);
    hn_json_string(b, points);
    hn_json_string(b, detail.n ? hn_strbuf_text(&detail) : "right");
    hn_json_end_array(b);
    b->failed |= detail.failed;
    hn_strbuf_reset(&detail);
}

void hn_verdict_coderunner(hn_strbuf *b, const hn_verdict *v) {
    static const char *const head[] = {"iscorrect", "Part", "Points", "What was found"};
    static const char *const formats[] = {"%s", "%s", "%s"}; // text, never markup
    hn_strbuf html;
    hn_strbuf_init(&html);
    hn_strbuf_add(&html, is_graded(v) ? "<p>" : "<p>This cannot be graded: ");
    hn_verdict_escape(&html, is_graded(v) ? v->summary : v->reason);
    hn_strbuf_add(&html, ". ");
    hn_verdict_escape(&html, is_graded(v) ? v->note : v->hint);
    hn_strbuf_add(&html, "</p>");

    hn_json_object(b);
    hn_json_put_number(b, "fraction", is_graded(v) ? share_of(v) : 0);
    hn_json_put_string(b, "prologuehtml", hn_strbuf_text(&html));
    hn_json_key(b, "testresults");
    hn_json_array(b);
    hn_json_strings(b, head, 4);
    for (int k = 0; k < v->n_entries && is_graded(v); k++) {
        put_row(b, v, &v->entry[k]);
    }
    hn_json_end_array(b);
    hn_json_key(b, "columnformats");
    hn_json_strings(b, formats, 3);
    hn_json_end_object(b);
    b->failed |= html.failed;
    hn_strbuf_reset(&html);
}

// ---- LTI ----

void hn_verdict_lti_score(hn_strbuf *b, const hn_verdict *v) {
    char stamp[64];
    struct timespec now;
    struct tm utc;
    clock_gettime(CLOCK_REALTIME, &now);
    gmtime_r(&now.tv_sec, &utc);
    const size_t n = strftime(stamp, sizeof stamp, "%Y-%m-%dT%H:%M:%S", &utc);
    snprintf(stamp + n, sizeof stamp - n, ".%03ldZ", now.tv_nsec / 1000000);

    hn_json_object(b);
    if (v->student[0]) { // an empty id would be posted for nobody
        hn_json_put_string(b, "userId", v->student);
    }
    if (is_graded(v)) {
        hn_json_put_number(b, "scoreGiven", v->score);
        hn_json_put_number(b, "scoreMaximum", v->max_score);
    }
    put_message(b, v, "comment");
    hn_json_put_string(b, "timestamp", stamp);
    hn_json_put_string(b, "activityProgress", is_graded(v) ? "Completed" : "Submitted");
    hn_json_put_string(b, "gradingProgress", is_graded(v) ? "FullyGraded" : "Failed");
    hn_json_end_object(b);
}
