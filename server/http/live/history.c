// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/live/history.h"

#include <string.h>

static const char *const NAMES[HN_EVENT_COUNT] = {
#define HN_EVENT_NAME(kind, name) name,
    HN_EVENT_LIST(HN_EVENT_NAME)
#undef HN_EVENT_NAME
};

const char *hn_event_name(hn_event_kind kind) {
    return NAMES[kind];
}

hn_status hn_history_init(hn_history *h, int max_events, size_t max_bytes) {
    *h = (hn_history){.cap = max_events, .max_bytes = max_bytes};
    h->ring = calloc((size_t)max_events, sizeof *h->ring);
    return h->ring ? HN_OK : HN_ERR_MEMORY;
}

static void drop_oldest(hn_history *h) {
    hn_event *e = &h->ring[h->head];
    h->bytes -= e->n;
    free(e->data);
    *e = (hn_event){0};
    h->head = (h->head + 1) % h->cap;
    h->n--;
}

void hn_history_reset(hn_history *h) {
    while (h->n > 0) {
        drop_oldest(h);
    }
    free(h->ring);
    *h = (hn_history){0};
}

void hn_history_add(hn_history *h, hn_event_kind kind, hn_strbuf *data) {
    hn_history_add_parts(h, kind, data, (const size_t[HN_EVENT_MAX_EXTRAS + 1]){0});
}

void hn_history_add_parts(hn_history *h, hn_event_kind kind, hn_strbuf *data,
                          const size_t extra[HN_EVENT_MAX_EXTRAS + 1]) {
    size_t n = data->n;
    char *text = hn_strbuf_take(data);
    n = text ? n : 0;
    while (h->n == h->cap || (h->n > 0 && h->bytes + n > h->max_bytes)) {
        drop_oldest(h);
    }
    uint64_t id = ++h->last_id;
    hn_event *e = &h->ring[(h->head + h->n) % h->cap];
    *e = (hn_event){.id = id, .kind = kind, .data = text, .n = n};
    memcpy(e->extra, extra, sizeof e->extra);
    h->n++;
    h->bytes += n;
    if (kind == HN_EVENT_FRAME) {
        h->last_frame_id = id;
    }
}

uint64_t hn_history_first_id(const hn_history *h) {
    return h->last_id + 1 - (uint64_t)h->n;
}

const hn_event *hn_history_find(const hn_history *h, uint64_t id) {
    uint64_t first = hn_history_first_id(h);
    if (id < first || id > h->last_id) {
        return NULL;
    }
    return &h->ring[((uint64_t)h->head + (id - first)) % (uint64_t)h->cap];
}
