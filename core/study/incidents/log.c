// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

hn_status hn_incident_log_create(hn_incident_log *log) {
    *log = (hn_incident_log){.list = malloc(HN_RUN_MAX_INCIDENTS * sizeof *log->list)};
    return log->list ? HN_OK : HN_ERR_MEMORY;
}

void hn_incident_log_free(hn_incident_log *log) {
    free(log->list);
    log->list = NULL;
}

void hn_incident_log_clear(hn_incident_log *log) {
    log->n = 0;
    log->active = 0;
    memset(log->reported, 0, sizeof log->reported);
    memset(log->times, 0, sizeof log->times);
}

bool hn_incident_holds(const hn_incident_log *log, hn_incident_code code) {
    return log->active >> code & 1u;
}

void hn_incident_over(hn_incident_log *log, hn_incident_code code) {
    log->active &= ~(1u << code);
}

static bool has_room(const hn_incident_log *log, hn_incident_code code) {
    return log->reported[code] < HN_INCIDENT_MOST_OF_ONE_KIND && log->n < HN_RUN_MAX_INCIDENTS;
}

bool hn_incident_begins(hn_incident_log *log, hn_incident_code code) {
    if (hn_incident_holds(log, code)) {
        return false;
    }
    log->active |= 1u << code;
    log->times[code]++;
    hn_incident *last = NULL;
    for (int i = 0; i < log->n; i++) {
        if (log->list[i].code == code) {
            last = &log->list[i];
            last->times = log->times[code];
        }
    }

    // one that is not listed is reported by the count of the last one that is
    if (last && !has_room(log, code)) {
        last->revision = ++log->revision;
    }
    return has_room(log, code);
}

hn_incident *hn_incident_add(hn_incident_log *log, const hn_incident *report) {
    const hn_incident_code code = report->code;
    if (!has_room(log, code)) {
        return NULL;
    }
    log->reported[code]++;
    hn_incident *i = &log->list[log->n++];
    *i = *report;
    i->times = log->times[code];
    i->revision = ++log->revision;
    return i;
}

void hn_incident_make_room(hn_incident_log *log, hn_incident_code code) {
    if (log->n == HN_RUN_MAX_INCIDENTS) {
        log->n--;
    }
    hn_incident_over(log, code);
    log->reported[code] = 0;
}

void hn_incident_append(hn_incident_log *log, hn_incident *i, const char *format, ...) {
    const size_t used = strlen(i->message);
    va_list args;
    va_start(args, format);
    vsnprintf(i->message + used, sizeof i->message - used, format, args);
    va_end(args);
    i->revision = ++log->revision;
}
