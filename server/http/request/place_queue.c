// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/request/place_queue.h"

#include "base/clock.h"
#include "http/request/context.h"

bool hn_place_queue_add(hn_place_queue *queue, hn_request *r, double seconds, int longest) {
    hn_request **end = &queue->first;
    int n_of_client = 0;
    for (; *end; end = &(*end)->next) {
        n_of_client += (*end)->client == r->client;
    }
    if (seconds <= 0 || queue->n >= longest ||
        (r->client && n_of_client >= hn_http_opts_share(&r->context->opts, longest))) {
        return false;
    }
    r->wait_until = hn_clock_wall() + seconds;
    r->next = NULL;
    *end = r;
    queue->n++;
    return true;
}

void hn_place_queue_serve(hn_place_queue *queue, const hn_place_rules *rules, bool is_stopping) {
    const double now = hn_clock_wall();
    int n_before = 0;
    for (hn_request **at = &queue->first; *at;) {
        hn_request *r = *at;
        const bool ends = is_stopping || now >= r->wait_until || hn_request_is_left(r);
        r->has_place = !ends && rules->take(rules->user, r->client);
        if (!ends && !r->has_place) {
            n_before++;
            at = &r->next;
            continue;
        }

        // from here on the request is another thread's
        *at = r->next;
        queue->n--;
        if (ends) {
            rules->refuse(rules->user, r, n_before);
            hn_request_finish(r);
        } else if (!hn_jobs_push(rules->jobs, r, r->queues_as, 0)) {
            rules->give(rules->user, r->client);
            hn_reply_queue_full(r, rules->jobs);
            hn_request_finish(r);
        }
    }
}
