// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/link.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char ADDRESS[] = "http://127.0.0.1:8080/#";

static void add_escaped(hn_strbuf *b, const char *text) {
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (isalnum(c) || strchr("-_.!~*'():,@=/", c)) {
            hn_strbuf_add_n(b, text, 1);
        } else {
            hn_strbuf_printf(b, "%%%02X", c);
        }
    }
}

void hn_workbench_link(const hn_workbench *w, hn_strbuf *b) {
    hn_strbuf_printf(b, "%sscene=", ADDRESS);
    add_escaped(b, w->scene);
    for (int i = 0; i < w->n_settings; i++) {
        hn_strbuf_printf(b, "&set.%s=%.17g", w->settings[i].name, w->settings[i].value);
    }
    for (int i = 0; i < w->n_methods; i++) {
        hn_strbuf_add(b, "&method=");
        add_escaped(b, w->methods[i]);
    }
    hn_strbuf_printf(b, "&frame=%d&selected=%d",
                     hn_recording_page_frame(w->recording, hn_workbench_frame(w)), w->selected);
}

/// Turns %40 and its like back; in place.
static void unescape(char *text) {
    char *to = text;
    for (const char *from = text; *from; from++) {
        unsigned code;
        if (*from == '%' && isxdigit((unsigned char)from[1]) && isxdigit((unsigned char)from[2]) &&
            sscanf(from + 1, "%2x", &code) == 1 && code >= 32) {
            *to++ = (char)code;
            from += 2;
        } else {
            *to++ = *from;
        }
    }
    *to = '\0';
}

bool hn_workbench_read_link(const char *link, char scene[HN_TUI_LINE], hn_setting *settings,
                            char (*names)[64], int *n_settings, char (*methods)[HN_SPEC_MAX],
                            int *n_methods) {
    const char *hash = strchr(link, '#');
    char copy[4096];
    if (!hash && strncmp(link, "scene=", 6) != 0) {
        return false;
    }
    snprintf(copy, sizeof copy, "%s", hash ? hash + 1 : link);
    scene[0] = '\0';
    *n_settings = *n_methods = 0;
    for (char *rest = copy, *item = strsep(&rest, "&"); item; item = strsep(&rest, "&")) {
        char *value = strchr(item, '=');
        if (!value) {
            snprintf(scene, HN_TUI_LINE, "%s", item);
            continue;
        }
        *value++ = '\0';
        unescape(item);
        unescape(value);
        if (strcmp(item, "scene") == 0) {
            snprintf(scene, HN_TUI_LINE, "%s", value);
        } else if (strcmp(item, "method") == 0 && *n_methods < HN_COMPARISON_MAX_METHODS) {
            snprintf(methods[(*n_methods)++], HN_SPEC_MAX, "%.250s", value);
        } else if (strncmp(item, "set.", 4) == 0 && *n_settings < HN_TUI_SETTINGS) {
            snprintf(names[*n_settings], 64, "%s", item + 4);
            settings[*n_settings] = (hn_setting){names[*n_settings], strtod(value, NULL)};
            (*n_settings)++;
        }
    }
    return scene[0] != '\0';
}
