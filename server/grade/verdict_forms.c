// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/verdict_forms.h"

#include "base/suggest.h"
#include "grade/verdict_platforms.h"
#include "grade/verdict_reports.h"

#include <string.h>

static void write_text(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    (void)x;
    hn_verdict_text(b, v);
}

static void write_json(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    (void)x;
    hn_verdict_json(b, v);
}

static void write_gradescope(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    hn_verdict_gradescope(b, v, x->seconds);
}

static void write_junit(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    hn_verdict_junit(b, v, x->submission);
}

static void write_csv(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    hn_verdict_csv(b, v, x->first);
}

static void write_html(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    hn_verdict_html(b, v, x->png);
}

static void write_prairielearn(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    hn_verdict_prairielearn(b, v, x->png);
}

static void write_autolab(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    (void)x;
    hn_verdict_autolab(b, v);
}

static void write_coderunner(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    (void)x;
    hn_verdict_coderunner(b, v);
}

static void write_lti(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x) {
    (void)x;
    hn_verdict_lti_score(b, v);
}

static const hn_verdict_form FORMS[] = {
    {"text", "txt", false, false, "", "", write_text},
    {"json", "json", false, false, "", "", write_json},
    {"gradescope", "json", true, false, "", "", write_gradescope},
    {"prairielearn", "json", true, true, "", "", write_prairielearn},
    {"autolab", "txt", false, false, "", "", write_autolab},
    {"coderunner", "json", false, false, "", "", write_coderunner},
    {"lti-score", "json", false, false, "", "", write_lti},
    {"junit", "xml", false, false, HN_VERDICT_JUNIT_HEAD, HN_VERDICT_JUNIT_TAIL, write_junit},
    {"csv", "csv", false, false, "", "", write_csv},
    {"html", "html", false, true, "", "", write_html},
};
enum { N_FORMS = sizeof FORMS / sizeof *FORMS };

hn_status hn_verdict_form_find(const char *name, const hn_verdict_form **out, hn_diag *diag) {
    const char *names[N_FORMS];
    for (int i = 0; i < N_FORMS; i++) {
        names[i] = FORMS[i].name;
        if (strcmp(name, FORMS[i].name) == 0) {
            *out = &FORMS[i];
            return HN_OK;
        }
    }
    char hint[HN_DIAG_HINT];
    return hn_diag_set(diag, HN_ERR_INPUT, NULL,
                       hn_suggest_or_list(hint, name, names, N_FORMS, "one of: "),
                       "'%.40s' is not a form of verdicts", name);
}

const hn_verdict_form *hn_verdict_form_of_file(const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    for (int i = 0; dot && i < N_FORMS; i++) {
        if (strcmp(dot + 1, FORMS[i].ending) == 0) {
            return &FORMS[i];
        }
    }
    return NULL;
}
