// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/verdict_reports.h"

#include "base/base64.h"
#include "render/canvas.h"

#include <stdbool.h>
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

typedef void put_entry(hn_strbuf *b, const hn_entry_verdict *e);

/// Writes what was given or is expected, with its value, as text of XML.
static void put_escaped(hn_strbuf *b, const hn_entry_verdict *e, put_entry *put) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    put(&text, e);
    hn_verdict_escape(b, hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
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
    if (e->given[0]) {
        hn_strbuf_add(b, "\ngiven     ");
        put_escaped(b, e, hn_verdict_given);
    }
    if (hn_verdict_shows_expected(v, e)) {
        hn_strbuf_add(b, "\nexpected  ");
        put_escaped(b, e, hn_verdict_expected);
    }
    hn_strbuf_add(b, "</failure>\n    </testcase>\n");
}

void hn_verdict_junit(hn_strbuf *b, const hn_verdict *v, const char *submission) {
    const int graded = v->kind == HN_VERDICT_GRADED;
    int failures = 0;
    for (int k = 0; k < v->n_entries && graded; k++) {
        failures += !is_full(&v->entry[k]);
    }
    hn_strbuf_add(b, "  <testsuite name=\"");
    hn_verdict_escape(b, v->problem->title);
    hn_strbuf_add(b, submission ? ": " : "");
    hn_verdict_escape(b, submission ? submission : "");
    hn_strbuf_printf(b, "\" tests=\"%d\" failures=\"%d\" errors=\"%d\">\n",
                     graded ? v->n_entries : 1, failures, !graded);

    // one case an entry, or one error
    for (int k = 0; k < v->n_entries && graded; k++) {
        put_case(b, v, &v->entry[k]);
    }
    if (!graded) {
        hn_strbuf_add(b, "    <testcase classname=\"");
        hn_verdict_escape(b, v->problem->id);
        hn_strbuf_add(b, "\" name=\"submission\">");
        hn_strbuf_printf(b, "<error type=\"%s\">", hn_verdict_status(v));
        hn_verdict_escape(b, v->reason);
        hn_strbuf_add(b, "</error></testcase>\n");
    }
    hn_strbuf_add(b, "  </testsuite>\n");
}

/// Style of the page: colours of both themes, and tables that fold on a
/// narrow screen.
static const char STYLE[] =
    ":root{color-scheme:light dark;--ink:#1a1d21;--muted:#5c626a;--paper:#fcfcfa;--line:#d5d8d4;"
    "--right:#1f7a45;--wrong:#b5372a}\n"
    "@media(prefers-color-scheme:dark){:root{--ink:#e8eaed;--muted:#9aa2ab;--paper:#14171b;"
    "--line:#343a42;--right:#5fc98b;--wrong:#ff8a75}figure{background:#fcfcfa}}\n"
    "body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);"
    "max-width:52em;margin:2em auto;padding:0 1em}\n"
    "h1{font-size:1.4em;margin:0}.score{font-size:1.2em;margin:.2em 0 "
    "1em}.muted{color:var(--muted)}"
    "\ntable{border-collapse:collapse;width:100%}th{text-align:left;font-weight:600}\n"
    "td,th{padding:.5em .8em;border-bottom:1px solid var(--line);vertical-align:top}\n"
    "td:first-child{font-weight:600;white-space:nowrap;border-left:4px solid var(--right)}\n"
    ".wrong td:first-child{border-left-color:var(--wrong)}td:nth-child(2){white-space:nowrap}\n"
    "code{font:.9em/1.4 ui-monospace,monospace;overflow-wrap:anywhere}\n"
    "figure{margin:1.5em 0;padding:.5em;border:1px solid var(--line)}figcaption{color:#5c626a}\n"
    "img{max-width:100%;display:block}\n"
    "@media(max-width:34em){thead{display:none}tr{display:block;padding:.5em 0}"
    "td,td:first-child{display:block;border-bottom:0;padding:.1em .8em}}\n";

static void put_code(hn_strbuf *b, const char *label, const char *text) {
    if (text[0]) {
        hn_strbuf_printf(b, "<br><span class=\"muted\">%s</span> <code>", label);
        hn_verdict_escape(b, text);
        hn_strbuf_add(b, "</code>");
    }
}

static void put_row(hn_strbuf *b, const hn_verdict *v, const hn_entry_verdict *e) {
    hn_strbuf_printf(b, "<tr class=\"%s\"><td>", e->right ? "right" : "wrong");
    hn_verdict_escape(b, e->name);
    hn_strbuf_printf(b, "</td><td>%g of %g</td><td>", e->points, e->max_points);
    hn_verdict_escape(b, e->right && !e->explanation[0] ? "right" : e->explanation);
    hn_strbuf given, expected;
    hn_strbuf_init(&given);
    hn_strbuf_init(&expected);
    if (e->given[0]) {
        hn_verdict_given(&given, e);
    }
    if (hn_verdict_shows_expected(v, e)) {
        hn_verdict_expected(&expected, e);
    }
    put_code(b, "your answer", hn_strbuf_text(&given));
    put_code(b, "expected", hn_strbuf_text(&expected));
    b->failed |= given.failed | expected.failed;
    hn_strbuf_reset(&given);
    hn_strbuf_reset(&expected);
    hn_strbuf_add(b, "</td></tr>\n");
}

/// The picture, as part of the page, with its words.
static void put_figure(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png) {
    if (!png || png->n == 0) {
        return;
    }
    const hn_entry_verdict *e = &v->entry[v->shown_entry];
    const char *what = v->view.overlay ? "Where the links stand by your answer to"
                       : v->view.scene ? "The mechanism of your answer to"
                                       : "The mechanism in a state that shows the mistake in";
    hn_strbuf_printf(b, "<figure><img alt=\"%s %s\" src=\"data:image/png;base64,", what, e->name);
    hn_base64(b, hn_strbuf_text(png), png->n);
    hn_strbuf_printf(b, "\"><figcaption>%s %s; drawn by %s.</figcaption></figure>\n", what, e->name,
                     strcmp(hn_canvas_renderer(), "OSMesa") == 0 ? "OSMesa"
                                                                 : "the built-in renderer");
}

/// A sentence below the outcome; nothing for an empty one.
static void put_remark(hn_strbuf *b, const char *text) {
    if (text[0]) {
        hn_strbuf_add(b, "<p class=\"muted\">");
        hn_verdict_escape(b, text);
        hn_strbuf_add(b, ".</p>\n");
    }
}

/// The sum, or why there is none.
static void put_outcome(hn_strbuf *b, const hn_verdict *v, bool graded) {
    hn_strbuf_add(b, "<p class=\"score\">");
    if (graded) {
        hn_strbuf_printf(b, "<strong>%g of %g points</strong>: ", v->score, v->max_score);
    } else {
        hn_strbuf_add(b, "<strong>Cannot be graded</strong>: ");
    }
    hn_verdict_escape(b, graded ? v->summary : v->reason);
    hn_strbuf_add(b, ".</p>\n");
    put_remark(b, graded ? "" : v->hint);
    put_remark(b, v->note);
}

/// Writes which variant was graded, or which program with which parameters, and whose it is.
static void put_origin(hn_strbuf *b, const hn_verdict *v) {
    const hn_graded_program *program = v->program;
    hn_strbuf_add(b, program ? "program " : "exercise ");
    hn_verdict_escape(b, program ? program->file : v->problem->id);
    hn_strbuf_add(b, v->student[0] ? ", handed in by " : "");
    hn_verdict_escape(b, v->student);
    if (!program) {
        hn_strbuf_printf(b, "; variant of seed %llu", (unsigned long long)v->seed);
    }
    for (int i = 0; program && i < program->n_set; i++) {
        hn_strbuf_add(b, i == 0 ? "; graded with " : ", ");
        hn_verdict_escape(b, program->set[i]);
    }
}

void hn_verdict_html(hn_strbuf *b, const hn_verdict *v, const hn_strbuf *png) {
    const bool graded = v->kind == HN_VERDICT_GRADED;
    hn_strbuf_add(b, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
                     "<meta name=\"viewport\" content=\"width=device-width\"><title>");
    hn_verdict_escape(b, v->problem->title);
    hn_strbuf_printf(b, "</title>\n<style>%s</style></head>\n<body><h1>", STYLE);
    hn_verdict_escape(b, v->problem->title);
    hn_strbuf_add(b, "</h1>\n<p class=\"muted\">");
    put_origin(b, v);
    hn_strbuf_add(b, "</p>\n");
    put_outcome(b, v, graded);
    if (graded) {
        hn_strbuf_add(b, "<table><thead><tr><th>part</th><th>points</th><th>verdict</th></tr>"
                         "</thead><tbody>\n");
        for (int k = 0; k < v->n_entries; k++) {
            put_row(b, v, &v->entry[k]);
        }
        hn_strbuf_add(b, "</tbody></table>\n");
    }
    put_figure(b, v, png);
    hn_strbuf_add(b, "</body></html>\n");
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
        // a right entry in the transposed place has a mistake too
        const hn_entry_verdict *e = &v->entry[k];
        if (e->mistake[0]) {
            hn_strbuf_printf(&mistakes, "%s%s: %s", mistakes.n ? "; " : "", e->name, e->mistake);
        }
        if (hn_verdict_shows_expected(v, e)) {
            hn_strbuf_add(&mistakes, " (expected ");
            hn_verdict_expected(&mistakes, e);
            hn_strbuf_add(&mistakes, ")");
        }
    }
    hn_strbuf_add(b, head ? "problem,student,seed,status,score,max_score,mistakes\n" : "");
    put_field(b, v->problem->id);
    hn_strbuf_add(b, ",");
    // a program without a student is known by its file
    put_field(b, v->student[0] || !v->program ? v->student : v->program->file);
    hn_strbuf_printf(b, ",%llu,%s,%g,%g,", (unsigned long long)v->seed, hn_verdict_status(v),
                     graded ? v->score : 0, v->max_score);
    put_field(b, graded ? hn_strbuf_text(&mistakes) : v->reason);
    hn_strbuf_add(b, "\n");
    b->failed |= mistakes.failed;
    hn_strbuf_reset(&mistakes);
}
