// SPDX-License-Identifier: GPL-3.0-or-later
#include "class/blank_programs.h"

#include "class/filled_program.h"
#include "export/language.h"
#include "session/export/export.h"

#include <string.h>
#include <strings.h>

/// Writes the program of one language, and reads what everyone has of it.
static hn_status add_language(hn_blank_programs *p, const hn_model *model, const hn_library *lib,
                              const hn_language *language) {
    hn_export_request request = {.language = language->name, .blanks = true};
    hn_diags diags = {0};
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_status status = hn_model_export(&text, model, lib, &request, &diags);
    if (status == HN_OK) {
        p->of[p->n].suffix = language->suffix;
        p->of[p->n].source =
            hn_given_source_read(hn_strbuf_text(&text), hn_source_style_of(language->suffix));
        status = p->of[p->n].source ? HN_OK : HN_ERR_MEMORY;
        p->n += status == HN_OK;
    }
    hn_strbuf_reset(&text);
    return status == HN_ERR_MEMORY ? status : HN_OK;
}

hn_status hn_blank_programs_init(hn_blank_programs *p, const hn_model *model,
                                 const hn_library *lib) {
    int n;
    const hn_language *all = hn_languages(&n);
    *p = (hn_blank_programs){0};
    hn_status status = HN_OK;
    for (int i = 0; i < n && p->n < HN_BLANK_PROGRAMS && status == HN_OK; i++) {
        if (hn_filled_program_is(all[i].suffix)) {
            status = add_language(p, model, lib, &all[i]);
        }
    }
    return status;
}

void hn_blank_programs_reset(hn_blank_programs *p) {
    for (int i = 0; i < p->n; i++) {
        hn_given_source_free(p->of[i].source);
    }
    *p = (hn_blank_programs){0};
}

const hn_given_source *hn_blank_programs_of(const hn_blank_programs *p, const char *file) {
    const char *dot = strrchr(file, '.');
    for (int i = 0; dot && i < p->n; i++) {
        if (strcasecmp(dot, p->of[i].suffix) == 0) {
            return p->of[i].source;
        }
    }
    return NULL;
}
