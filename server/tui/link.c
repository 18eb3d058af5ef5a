// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/link.h"

#include "base/shortest.h"
#include "base/suggest.h"
#include "cli/shell/args.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double LEAST_SPEED = 1e-3, MOST_SPEED = 1e3; // of the page's links
static const char ADDRESS[] = "http://127.0.0.1:8080/#";

/// The name that the page has for the quantity of each plot (web/state/quantities.js).
static const char *const QUANTITY[HN_TUI_PLOTS] = {
    [HN_TUI_GAP] = "gap", [HN_TUI_ERROR] = "off", [HN_TUI_ENERGY] = "energy_change"};

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

    // what is here by itself is left out
    if (w->speed != 1) {
        char speed[HN_SHORTEST_TEXT];
        hn_shortest_write(w->speed, speed);
        hn_strbuf_printf(b, "&speed=%s", speed);
    }
    if (w->plot != HN_TUI_GAP) {
        hn_strbuf_printf(b, "&upper=%s", QUANTITY[w->plot]);
    }
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

/// Fields of the page's links (web/state/link.js) that a terminal has no use for.
static const char *const OF_THE_PAGE[] = {"hidden", "show",  "look",   "camera", "lower", "zoom",
                                          "why",    "study", "map",    "judged", "until", "step",
                                          "budget", "panel", "lesson", "note",   "build"};
/// Those that are read here; "set." begins the name of a parameter.
static const char *const FIELDS[] = {"scene", "method", "frame", "selected",
                                     "speed", "upper",  "pulls", "set."};
enum {
    N_OF_THE_PAGE = sizeof OF_THE_PAGE / sizeof *OF_THE_PAGE,
    N_FIELDS = sizeof FIELDS / sizeof *FIELDS
};

HN_PRINTF(2, 3) static void add_fault(hn_tui_link *link, const char *format, ...) {
    const size_t n = strlen(link->faults);
    va_list list;
    if (n + 3 < sizeof link->faults) {
        snprintf(link->faults + n, sizeof link->faults - n, "%s", n > 0 ? "; " : "");
        const size_t at = strlen(link->faults);
        va_start(list, format);
        vsnprintf(link->faults + at, sizeof link->faults - at, format, list);
        va_end(list);
    }
}

static void take_setting(hn_tui_link *link, const char *name, const char *value) {
    double number;
    if (!hn_number_parse(value, &number)) {
        add_fault(link, "%.40s is '%.40s', which is no number; it has the scene's value", name,
                  value);
    } else if (link->n_settings < HN_TUI_SETTINGS) {
        char *to = link->names[link->n_settings];
        snprintf(to, sizeof *link->names, "%s", name);
        link->settings[link->n_settings++] = (hn_setting){to, number};
    } else {
        add_fault(link, "more than %d parameters; '%.40s' is left out", HN_TUI_SETTINGS, name);
    }
}

static void take_method(hn_tui_link *link, const char *value) {
    if (link->n_methods < HN_COMPARISON_MAX_METHODS) {
        snprintf(link->methods[link->n_methods++], HN_SPEC_MAX, "%.250s", value);
    } else {
        add_fault(link, "more than %d methods; '%.60s' is left out", HN_COMPARISON_MAX_METHODS,
                  value);
    }
}

/// A whole number from 0 to `most`; a value that is none leaves what was there.
static void take_number(hn_tui_link *link, int *to, const char *name, const char *value,
                        double most) {
    double number;
    if (hn_number_parse(value, &number) && number >= 0 && number <= most) {
        *to = (int)number;
    } else {
        add_fault(link, "%s is '%.40s'; a number from 0 to %g is needed", name, value, most);
    }
}

static void take_speed(hn_tui_link *link, const char *value) {
    double speed;
    if (hn_number_parse(value, &speed) && speed >= LEAST_SPEED && speed <= MOST_SPEED) {
        link->speed = speed;
    } else {
        add_fault(link, "speed is '%.40s'; a number from %g to %g is needed", value, LEAST_SPEED,
                  MOST_SPEED);
    }
}

/// The quantity before the first comma; one that is not plotted here leaves what was there.
static void take_plot(hn_tui_link *link, const char *value) {
    const size_t n = strcspn(value, ",");
    for (int i = 0; i < HN_TUI_PLOTS; i++) {
        if (strlen(QUANTITY[i]) == n && strncmp(QUANTITY[i], value, n) == 0) {
            link->plot = (hn_tui_plot)i;
        }
    }
}

/// A field that is not read: one of the page alone, or misspelt.
static void take_other(hn_tui_link *link, const char *name) {
    const char *names[N_FIELDS + N_OF_THE_PAGE];
    char hint[HN_DIAG_HINT];
    memcpy(names, FIELDS, sizeof FIELDS);
    memcpy(names + N_FIELDS, OF_THE_PAGE, sizeof OF_THE_PAGE);
    for (int i = 0; i < N_OF_THE_PAGE; i++) {
        if (strcmp(name, OF_THE_PAGE[i]) == 0) {
            return;
        }
    }
    hn_suggest(hint, name, names, N_FIELDS + N_OF_THE_PAGE, "");
    add_fault(link, "no field is called '%.40s'%s%s", name, hint[0] ? "; " : "", hint);
}

static void take_item(hn_tui_link *link, const char *name, const char *value) {
    if (strcmp(name, "scene") == 0) {
        snprintf(link->scene, sizeof link->scene, "%s", value);
    } else if (strcmp(name, "method") == 0) {
        take_method(link, value);
    } else if (strncmp(name, "set.", 4) == 0) {
        take_setting(link, name + 4, value);
    } else if (strcmp(name, "frame") == 0) {
        take_number(link, &link->frame, name, value, 1e6);
    } else if (strcmp(name, "selected") == 0) {
        take_number(link, &link->selected, name, value, HN_COMPARISON_MAX_METHODS - 1);
    } else if (strcmp(name, "speed") == 0) {
        take_speed(link, value);
    } else if (strcmp(name, "upper") == 0) {
        take_plot(link, value);
    } else if (strcmp(name, "pulls") == 0) {
        add_fault(link, "a hand pulls at the mechanism there; here the motion is without it");
    } else {
        take_other(link, name);
    }
}

bool hn_workbench_read_link(const char *text, hn_tui_link *link) {
    const char *hash = strchr(text, '#');
    char copy[4096];
    *link = (hn_tui_link){.frame = -1, .speed = 1, .plot = HN_TUI_GAP};
    if (!hash && strncmp(text, "scene=", 6) != 0) {
        return false;
    }
    snprintf(copy, sizeof copy, "%s", hash ? hash + 1 : text);
    if (strlen(hash ? hash + 1 : text) >= sizeof copy) {
        add_fault(link, "what is behind its %zu bytes is left out", sizeof copy - 1);
    }
    const bool is_scene = !strchr(copy, '='); // the name of a scene alone
    for (char *rest = copy, *item = strsep(&rest, "&"); item; item = strsep(&rest, "&")) {
        char *value = strchr(item, '=');
        if (is_scene) {
            snprintf(link->scene, sizeof link->scene, "%s", item);
            continue;
        }
        if (!value) {
            if (*item) {
                add_fault(link, "'%.40s' has no value", item);
            }
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
    w->speed = link->speed;
    w->plot = link->plot;
}
