// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/link.h"

#include "base/shortest.h"

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
        char value[HN_SHORTEST_TEXT];
        hn_shortest_write(w->settings[i].value, value);
        hn_strbuf_printf(b, "&set.%s=%s", w->settings[i].name, value);
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

static void take_setting(hn_tui_link *link, const char *name, const char *value) {
    if (link->n_settings < HN_TUI_SETTINGS) {
        char *to = link->names[link->n_settings];
        snprintf(to, sizeof *link->names, "%s", name);
        link->settings[link->n_settings++] = (hn_setting){to, strtod(value, NULL)};
    }
}

/// A whole number from 0 to `most`; a value that is none leaves what was there.
static void take_number(int *to, const char *value, double most) {
    char *end;
    const double number = strtod(value, &end);
    if (end != value && *end == '\0' && number >= 0 && number <= most) {
        *to = (int)number;
    }
}

static void take_item(hn_tui_link *link, const char *name, const char *value) {
    if (strcmp(name, "scene") == 0) {
        snprintf(link->scene, sizeof link->scene, "%s", value);
    } else if (strcmp(name, "method") == 0 && link->n_methods < HN_COMPARISON_MAX_METHODS) {
        snprintf(link->methods[link->n_methods++], HN_SPEC_MAX, "%.250s", value);
    } else if (strncmp(name, "set.", 4) == 0) {
        take_setting(link, name + 4, value);
    } else if (strcmp(name, "frame") == 0) {
        take_number(&link->frame, value, 1e6);
    } else if (strcmp(name, "selected") == 0) {
        take_number(&link->selected, value, HN_COMPARISON_MAX_METHODS - 1);
    }
}

bool hn_workbench_read_link(const char *text, hn_tui_link *link) {
    const char *hash = strchr(text, '#');
    char copy[4096];
    *link = (hn_tui_link){.frame = -1};
    if (!hash && strncmp(text, "scene=", 6) != 0) {
        return false;
    }
    snprintf(copy, sizeof copy, "%s", hash ? hash + 1 : text);
    for (char *rest = copy, *item = strsep(&rest, "&"); item; item = strsep(&rest, "&")) {
        char *value = strchr(item, '=');
        if (!value) {
            snprintf(link->scene, sizeof link->scene, "%s", item);
            continue;
        }
        *value++ = '\0';
        unescape(item);
        unescape(value);
        take_item(link, item, value);
    }
    return link->scene[0] != '\0';
}

void hn_workbench_go_to_link(hn_workbench *w, const hn_tui_link *link) {
    if (link->frame >= 0) {
        const int last = hn_recording_last(w->recording);
        const int frame = link->frame / hn_recording_page_frame(w->recording, 1);
        w->clock = frame < last ? frame : last;
        w->playing = false;
        hn_recording_want(w->recording, (int)w->clock);
    }
    w->selected = link->selected < w->n_methods ? link->selected : 0;
}
