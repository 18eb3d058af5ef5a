// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/verdict_reports.h"

#include "base/base64.h"

#include <string.h>

void hn_verdict_escape(hn_strbuf *b, const char *text) {
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c == '<' || c == '>' || c == '&' || c == '"') {
            hn_strbuf_printf(b, "&#%d;", c);
        } else if (c >= ' ' || c == '\n' || c == '\t') {
            hn_strbuf_add_n(b, text, 1);
        }
    }
}

static int is_full(const hn_entry_verdict *e) {
    return e->points >= e->max_points;
}

static void put_case(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e) {
    hn_strbuf_add(b, "    <testcase classname=\"");
    hn_verdict_escape(b, v->problem->id);
    hn_strbuf_add(b, "\" name=\"");
    hn_verdict_escape(b, e->name);
    if (is_full(e)) {
        hn_strbuf_add(b, "\"/>\n");
        return;
    }
    hn_strbuf_add(b, "\">\n      <failure type=\"");
    hn_verdict_escape(b, e->mistake);
    hn_strbuf_printf(b, "\" message=\"%g of %g points\">", e->points, e->max_points);
    hn_verdict_escape(b, e->explanation);
    hn_strbuf_add(b, "</failure>\n    </testcase>\n");
}

void hn_verdict_junit(hn_strbuf *b, const hn_verdict *v) {
    const int graded = v->kind == HN_VERDICT_GRADED;
    int failures = 0;
    for (int k = 0; k < v->n_entries && graded; k++) {
        failures += !is_full(&v->entry[k]);
    }
    hn_strbuf_add(b,
                  "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"");
    hn_verdict_escape(b, v->problem->title);
    hn_strbuf_printf(b, "\" tests=\"%d\" failures=\"%d\" errors=\"%d\">\n",
                     graded ? v->n_entries : 1, failures, !graded);

    // one case an entry, or one error
    for (int k = 0; k < v->n_entries && graded; k++) {
        put_case(b, v, &v->entry[k]);
    }
    if (!graded) {
        hn_strbuf_add(b, "    <testcase classname=\"");
        hn_verdict_escape(b, v->problem->id);
        hn_strbuf_add(b, "\" name=\"submission\"><error type=\"ungradable\">");
        hn_verdict_escape(b, v->reason);
        hn_strbuf_add(b, "</error></testcase>\n");
    }
    hn_strbuf_add(b, "  </testsuite>\n</testsuites>\n");
}

static void put_row(hn_strbuf *b, const hn_entry_verdict *e) {
    hn_strbuf_printf(b, "<tr class=\"%s\"><td>", e->right ? "right" : "wrong");
    hn_verdict_escape(b, e->name);
    hn_strbuf_printf(b, "</td><td>%g of %g</td><td>", e->points, e->max_points);
    hn_verdict_escape(b, e->right ? "right" : e->explanation);
    hn_strbuf_add(b, "</td><td>");
    hn_verdict_escape(b, e->given);
    hn_strbuf_add(b, "</td></tr>\n");
}

/// The picture, as part of the page, with its words.
static void put_figure(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png) {
    if (!png || png->n == 0) {
        return;
    }
    const hn_entry_verdict *e = &v->entry[v->shown_entry];
    hn_strbuf_printf(b, "<figure><img alt=\"The mechanism in a state where %s is wrong\" src=\"",
                     e->name);
    hn_strbuf_add(b, "data:image/png;base64,");
    hn_base64(b, hn_strbuf_text(png), png->n);
    hn_strbuf_printf(b, "\"><figcaption>A state where %s is wrong.</figcaption></figure>\n",
                     e->name);
}

void hn_verdict_html(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png) {
    const int graded = v->kind == HN_VERDICT_GRADED;
    hn_strbuf_add(b, "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>");
    hn_verdict_escape(b, v->problem->title);
    hn_strbuf_add(b,
                  "</title>\n<style>body{font:15px/1.5 sans-serif;max-width:50em;margin:2em auto}"
                  "figure{margin:1em 0}img{max-width:100%}"
                  "td{padding:.3em .8em;border-bottom:1px solid #ccc;vertical-align:top}"
                  ".wrong td:first-child{border-left:3px solid #b5472f}"
                  ".right td:first-child{border-left:3px solid #2f7d4f}</style>\n<h1>");
    hn_verdict_escape(b, v->problem->title);
    hn_strbuf_add(b, "</h1>\n<p>");
    if (graded) {
        hn_strbuf_printf(b, "%g of %g points: ", v->score, v->max_score);
    }
    hn_verdict_escape(b, graded ? v->summary : v->reason);
    hn_strbuf_add(b, graded ? ".</p>\n<table>\n" : ".</p>\n<p>");

    // the entries, or what to do
    for (int k = 0; k < v->n_entries && graded; k++) {
        put_row(b, &v->entry[k]);
    }
    hn_verdict_escape(b, graded ? "" : v->hint);
    hn_strbuf_add(b, graded ? "</table>\n" : "</p>\n");
    put_figure(b, v, png);
    hn_strbuf_printf(b, "<p>Variant of seed %llu", (unsigned long long)v->seed);
    hn_strbuf_add(b, v->student[0] ? ", " : "");
    hn_verdict_escape(b, v->student);
    hn_strbuf_add(b, ".</p></html>\n");
}

/// A field in quotes, quotes doubled. One that a spreadsheet would take for a formula gets a blank
/// in front.
static void put_field(hn_strbuf *b, const char *text) {
    hn_strbuf_add(b, *text && strchr("=+-@", *text) ? "\" " : "\"");
    for (; *text; text++) {
        hn_strbuf_add(b, *text == '"' ? "\"" : "");
        hn_strbuf_add_n(b, text, 1);
    }
    hn_strbuf_add(b, "\"");
}

void hn_verdict_csv(hn_strbuf *b, const hn_verdict *v, int head) {
    const int graded = v->kind == HN_VERDICT_GRADED;
    hn_strbuf mistakes;
    hn_strbuf_init(&mistakes);
    for (int k = 0; k < v->n_entries && graded; k++) {
        if (!v->entry[k].right) {
            hn_strbuf_printf(&mistakes, "%s%s: %s", mistakes.n ? "; " : "", v->entry[k].name,
                             v->entry[k].mistake);
        }
    }
    hn_strbuf_add(b, head ? "problem,student,seed,status,score,max_score,mistakes\n" : "");
    put_field(b, v->problem->id);
    hn_strbuf_add(b, ",");
    put_field(b, v->student);
    hn_strbuf_printf(b, ",%llu,%s,%g,%g,", (unsigned long long)v->seed,
                     graded ? "graded" : "ungradable", graded ? v->score : 0, v->max_score);
    put_field(b, graded ? hn_strbuf_text(&mistakes) : v->reason);
    hn_strbuf_add(b, "\n");
    b->failed |= mistakes.failed;
    hn_strbuf_reset(&mistakes);
}
