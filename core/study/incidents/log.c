// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void hn_incident_log_clear(hn_incident_log *log) {
    log->n = 0;
    log->active = 0;
    memset(log->reported, 0, sizeof log->reported);
}

bool hn_incident_holds(const hn_incident_log *log, hn_incident_code code) {
    return log->active >> code & 1u;
}

void hn_incident_over(hn_incident_log *log, hn_incident_code code) {
    log->active &= ~(1u << code);
}

bool hn_incident_is_taken(const hn_incident_log *log, hn_incident_code code) {
    return !hn_incident_holds(log, code) && log->reported[code] < HN_INCIDENT_MOST_OF_ONE_KIND &&
           log->n < HN_RUN_MAX_INCIDENTS;
}

hn_incident *hn_incident_add(hn_incident_log *log, const hn_incident *report) {
    const hn_incident_code code = report->code;
    if (!hn_incident_is_taken(log, code)) {
        return NULL;
    }
    log->active |= 1u << code;
    log->reported[code]++;
    hn_incident *i = &log->list[log->n++];
    *i = *report;
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
