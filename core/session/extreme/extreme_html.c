// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/extreme/extreme_html.h"

#include "session/extreme/extreme_verdict.h"
#include "session/style/style.h"

#include "session/extreme/extreme_internal.h"

#include "session/precision/study_html.h"
#include "session/precision/study_page.h"

#include <stdio.h>

static const char *css_class(hn_extreme_verdict verdict) {
    return verdict <= HN_EXTREME_FAIL ? hn_extreme_verdict_name(verdict) : "none";
}

static void put_text(hn_strbuf *b, const char *tag, const char *text) {
    hn_strbuf_printf(b, "<%s>", tag);
    hn_html_text(b, text ? text : "");
    hn_strbuf_printf(b, "</%.2s>", tag);
}

static void put_why(hn_strbuf *b, const char *label, const char *text) {
    if (text) {
        hn_strbuf_printf(b, "<span class=\"why\">%s", label);
        hn_html_text(b, text);
        hn_strbuf_add(b, "</span>");
    }
}

static void put_trial(hn_strbuf *b, const hn_extreme_trial *t) {
    hn_strbuf_add(b, "<tr><td>");
    hn_html_text(b, t->what);
    put_why(b, "", t->expect.reason);
    put_why(b, "Source: ", t->expect.source);
    if (t->expect.was) {
        put_why(b, "Predicted before: ", t->expect.was);
        put_why(b, "Corrected, because: ", t->expect.was_why);
        put_why(b, "Source: ", t->expect.was_source);
    }
    hn_strbuf_add(b, "</td>");
    put_text(b, "td", t->expect.text);
    put_text(b, "td", t->observed);
    hn_strbuf_printf(b, "<td class=\"v %s\">%s</td></tr>", css_class(t->verdict),
                     hn_extreme_verdict_name(t->verdict));
}

static void put_case(hn_strbuf *b, const hn_extreme_case *c) {
    hn_strbuf_printf(b, "<h2 id=\"%s\">%s: ", c->id, c->id);
    hn_html_text(b, c->title);
    hn_strbuf_add(b, "</h2>");
    put_text(b, "p", c->why);
    if (c->about) {
        hn_strbuf_add(b, "<p class=\"quiet\">");
        hn_html_text(b, c->about);
        hn_strbuf_add(b, "</p>");
    }
    hn_page_table(b, c->id);
    hn_strbuf_add(b, "<thead><tr><th>what</th><th>predicted</th><th>observed</th><th>verdict</th>"
                     "</tr></thead><tbody>");
    for (int i = 0; i < c->n_trials; i++) {
        put_trial(b, &c->trials[i]);
    }
    hn_strbuf_add(b, "</tbody></table></div>");
}

static void put_summary(hn_strbuf *b, const hn_extreme *x) {
    hn_page_table(b, "All cases");
    hn_strbuf_add(b, "<thead><tr><th>case</th><th>what</th><th>trials</th><th>verdict</th></tr>"
                     "</thead><tbody>");
    for (int i = 0; i < x->n_cases; i++) {
        const hn_extreme_case *c = &x->cases[i];
        hn_strbuf_printf(b, "<tr><th scope=\"row\"><a href=\"#%s\">%s</a></th>", c->id, c->id);
        put_text(b, "td", c->title);
        hn_strbuf_printf(b, "<td>%d</td><td class=\"v %s\">%s</td></tr>", c->n_trials,
                         css_class(c->verdict), hn_extreme_verdict_name(c->verdict));
    }
    hn_strbuf_add(b, "</tbody></table></div>");
}

void hn_extreme_html(hn_strbuf *b, const hn_extreme *x) {
    hn_page_head(b, "holonom: the extreme matrix", hn_style_extreme);
    hn_strbuf_add(b,
                  "<h1>The extreme matrix</h1><p>Cases in which methods break, and whether theory "
                  "predicts it. Each prediction was written down with its reason before the case "
                  "was run. Pass: the observation is inside the predicted band. Warn: it is "
                  "outside, by at most three times the tolerance or a factor of ten beyond a "
                  "bound, or it is outside for some of the methods only.</p><p class=\"quiet\">");
    for (int v = 0; v < HN_EXTREME_VERDICTS; v++) {
        const hn_extreme_verdict verdict = (hn_extreme_verdict)v;
        if (hn_extreme_count(x, verdict) > 0) {
            hn_strbuf_printf(b, "%s: %d. ", hn_extreme_verdict_name(verdict),
                             hn_extreme_count(x, verdict));
        }
    }
    hn_strbuf_add(b, "</p>");
    put_summary(b, x);
    for (int i = 0; i < x->n_cases; i++) {
        put_case(b, &x->cases[i]);
    }
    hn_strbuf_add(b, "</main></body></html>\n");
}
