// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/incidents/report.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static void offer_remedies(const hn_watch *w, const hn_incident_kind *kind, hn_incident *i) {
    const int n = (int)(sizeof kind->remedies / sizeof *kind->remedies);
    int offered = 0;
    for (int k = 0; k < n && kind->remedies[k].write && offered < HN_REMEDIES; k++) {
        hn_remedy text;
        if (kind->remedies[k].write(w, kind->remedies[k].factor, text)) {
            memcpy(i->remedy[offered++], text, sizeof text);
        }
    }
}

/// Keeps the state from which remedies of a report can be tried later, when the run has gone on.
static void keep_before(hn_watch *w, const hn_incident *i) {
    const hn_stepping *run = w->run;
    const ptrdiff_t k = i - w->log.list;
    w->before[k].t = run->shortly.t;
    memcpy(w->before[k].q, run->shortly.q, (size_t)run->info.nq * sizeof(double));
    memcpy(w->before[k].v, run->shortly.v, (size_t)run->info.nv * sizeof(double));
    w->before_at[k] = run->steps + run->rejected;
}

static hn_incident *put(hn_watch *w, const hn_incident_kind *kind, const char *quantity,
                        double value, double limit, const char *format, va_list args) {
    hn_incident *i = hn_incident_add(&w->log, &(hn_incident){.code = kind->code,
                                                             .t = w->run->now.t,
                                                             .quantity = quantity,
                                                             .value = value,
                                                             .limit = limit});
    if (!i) {
        return NULL;
    }
    vsnprintf(i->message, sizeof i->message, format, args);
    if (w->log.reported[kind->code] == HN_INCIDENT_MOST_OF_ONE_KIND) {
        hn_incident_append(&w->log, i, "; later incidents of this kind are counted, not listed");
    }
    offer_remedies(w, kind, i);
    keep_before(w, i);
    return i;
}

hn_incident *hn_incident_put(hn_watch *w, const hn_incident_kind *kind, const char *quantity,
                             double value, double limit, const char *format, ...) {
    va_list args;
    va_start(args, format);
    hn_incident *i = put(w, kind, quantity, value, limit, format, args);
    va_end(args);
    return i;
}

hn_incident *hn_incident_report(hn_watch *w, const hn_incident_kind *kind, const char *quantity,
                                double value, double limit, const char *format, ...) {
    if (!hn_incident_begins(&w->log, kind->code)) { // a condition that goes on costs nothing
        return NULL;
    }
    va_list args;
    va_start(args, format);
    hn_incident *i = put(w, kind, quantity, value, limit, format, args);
    va_end(args);
    return i;
}
