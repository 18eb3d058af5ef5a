// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/connections.h"

#include "base/clock.h"
#include "base/strbuf.h"
#include "http/ground/closing_head.h"
#include "http/ground/problem_document.h"

#include <linux/tcp.h>
#include <math.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>

enum { LOOK_MS = 250 };
/// The part of the library's own limit after which a request that stands still is answered.
static const double QUIET = 0.9;
/// [s] An answer has been on its way for this long at least, where its reader's pace is taken.
static const double SHORTEST = 1e-3;

/// Activity of a connection; one whose place is needed is sought in this order.
typedef enum connection_state {
    STATE_IDLE,  ///< nothing, or its request comes in
    STATE_SENDS, ///< its answer goes out
    STATE_SERVED ///< its place is its own
} connection_state;

struct hn_connection_watch {
    int fd;
    hn_client client;
    bool has_place; ///< it is counted; under the lock, as is all that follows
    connection_state state;
    double since;    ///< it has been in this state since then [s, wall clock]
    double n_read;   ///< what its client had acknowledged by then [byte]
    double deadline; ///< it is closed then [s, wall clock]
    bool asks;       ///< a request has begun that has no answer yet
    bool has_ended;  ///< it has been shut down: nothing is begun for it any more
    double last;     ///< something of that request came then [s, wall clock]
    hn_connection_watch *next, *before;
};

struct hn_connections {
    pthread_mutex_t lock;
    pthread_cond_t ending;
    const hn_http_opts *opts;
    hn_connection_watch *first;
    hn_shares *places;
    hn_strbuf late;   ///< the answer to a request that comes too slowly
    double last_slow; ///< a slow reader was ended last then [s, wall clock]
    pthread_t thread;
    int has_thread, stop;
};

/// Ends a connection, which the library then finds closed, and gives up its place. With the lock
/// held.
static void end(hn_connections *all, hn_connection_watch *w) {
    shutdown(w->fd, SHUT_RDWR);
    w->has_ended = true;
    w->deadline = HUGE_VAL;
    if (w->has_place) {
        hn_shares_give(all->places, w->client);
        w->has_place = false;
    }
}

/// Tells a client that its request comes too slowly. Its answer fits into what the system
/// keeps for a socket; a client that has gone needs none. With the lock held.
static void tell_late(hn_connections *all, const hn_connection_watch *w) {
    const ssize_t sent = all->late.failed ? 0
                                          : send(w->fd, hn_strbuf_text(&all->late), all->late.n,
                                                 MSG_DONTWAIT | MSG_NOSIGNAL);
    (void)sent;
}

/// Ends what is beyond its deadline, and what stands still in the midst of a request. With the lock
/// held: an answer is announced under it before it is sent, so that none is on its way here.
static void look(hn_connections *all) {
    const double now = hn_clock_wall(), quiet = QUIET * all->opts->connection_timeout;
    for (hn_connection_watch *w = all->first; w; w = w->next) {
        const bool reads = w->asks && w->state == STATE_IDLE;
        if (now <= w->deadline && !(reads && now > w->last + quiet)) {
            continue;
        }
        if (reads && w->deadline < HUGE_VAL) {
            tell_late(all, w);
        }
        w->asks = false;
        end(all, w);
    }
}

/// The whole answer to a request that comes too slowly.
static void write_late(hn_strbuf *b) {
    hn_strbuf document;
    hn_strbuf_init(&document);
    hn_http_problem_json(&document, HN_PROBLEM_LATE, "the request stopped coming in", NULL, NULL,
                         -1, NULL);
    hn_closing_head_put(b, hn_http_problem_get_info(HN_PROBLEM_LATE)->status,
                        "application/problem+json", document.n);
    hn_strbuf_printf(b, "\r\n%s", hn_strbuf_text(&document));
    b->failed |= document.failed;
    hn_strbuf_reset(&document);
}

static void *watch(void *arg) {
    hn_connections *all = arg;
    pthread_mutex_lock(&all->lock);
    while (!all->stop) {
        struct timespec ts;
        clock_gettime(CLOCK_MONOTONIC, &ts);
        ts.tv_nsec += LOOK_MS * 1000000L;
        ts.tv_sec += ts.tv_nsec / 1000000000L;
        ts.tv_nsec %= 1000000000L;
        pthread_cond_timedwait(&all->ending, &all->lock, &ts);
        look(all);
    }
    pthread_mutex_unlock(&all->lock);
    return NULL;
}

hn_connections *hn_connections_create(const hn_http_opts *opts) {
    hn_connections *all = calloc(1, sizeof *all);
    if (!all) {
        return NULL;
    }
    pthread_condattr_t attr;
    pthread_condattr_init(&attr);
    pthread_condattr_setclock(&attr, CLOCK_MONOTONIC);
    pthread_cond_init(&all->ending, &attr);
    pthread_condattr_destroy(&attr);
    pthread_mutex_init(&all->lock, NULL);
    all->opts = opts;
    all->last_slow = -HUGE_VAL;
    hn_strbuf_init(&all->late);
    write_late(&all->late);
    all->places =
        hn_shares_create(opts->max_connections, hn_http_opts_share(opts, opts->max_connections));

    all->has_thread = all->places && pthread_create(&all->thread, NULL, watch, all) == 0;
    if (!all->has_thread) {
        hn_connections_free(all);
        return NULL;
    }
    return all;
}

void hn_connections_free(hn_connections *all) {
    if (!all) {
        return;
    }
    pthread_mutex_lock(&all->lock);
    all->stop = 1;
    pthread_cond_signal(&all->ending);
    pthread_mutex_unlock(&all->lock);
    if (all->has_thread) {
        pthread_join(all->thread, NULL);
    }
    pthread_cond_destroy(&all->ending);
    pthread_mutex_destroy(&all->lock);
    hn_shares_free(all->places);
    hn_strbuf_reset(&all->late);
    free(all);
}

/// Bytes that the other side of a connection has acknowledged so far; 0 where the system does not
/// count them.
static double bytes_read(int fd) {
    struct tcp_info info = {0};
    socklen_t n = sizeof info;
    return getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &n) == 0 ? (double)info.tcpi_bytes_acked
                                                                 : 0;
}

/// Returns whether `a` is to give up its place rather than `b`.
static bool goes_before(const hn_connection_watch *a, const hn_connection_watch *b) {
    return a->state != b->state ? a->state < b->state : a->since < b->since;
}

/// Ends the connection, of a client or (`of_any`) of all, that goes before the others. With the
/// lock held. Returns false when each of them is being served.
static bool end_oldest(hn_connections *all, hn_client client, bool of_any) {
    hn_connection_watch *first = NULL;
    for (hn_connection_watch *w = all->first; w; w = w->next) {
        if (w->has_place && w->state < STATE_SERVED && (of_any || w->client == client) &&
            (!first || goes_before(w, first))) {
            first = w;
        }
    }
    if (first) {
        end(all, first);
    }
    return first != NULL;
}

bool hn_connections_make_room(hn_connections *all, hn_client client) {
    pthread_mutex_lock(&all->lock);
    bool has_room = hn_shares_has_place(all->places, client);
    if (!has_room && hn_shares_has_share(all->places, client)) {
        has_room = end_oldest(all, client, false);
    } else if (!has_room) {
        // where all are being served, the event loops still take some connections without a place
        const hn_client greediest = hn_shares_greediest(all->places);
        if (!end_oldest(all, greediest, false)) {
            end_oldest(all, 0, true);
        }
        has_room = true;
    }
    pthread_mutex_unlock(&all->lock);
    return has_room;
}

bool hn_connections_end_slowest(hn_connections *all, double seconds) {
    hn_connection_watch *slowest = NULL;
    double least = HUGE_VAL; // [byte/s]
    pthread_mutex_lock(&all->lock);
    const double now = hn_clock_wall();
    const bool is_due = now >= all->last_slow + all->opts->unread_pause;
    for (hn_connection_watch *w = all->first; is_due && w; w = w->next) {
        const double waits = now - w->since;
        if (w->has_place && w->state == STATE_SENDS && waits >= seconds) {
            const double rate = (bytes_read(w->fd) - w->n_read) / fmax(waits, SHORTEST);
            if (!slowest || rate < least || (rate == least && w->since < slowest->since)) {
                slowest = w;
                least = rate;
            }
        }
    }
    if (slowest) {
        all->last_slow = now;
        end(all, slowest);
    }
    pthread_mutex_unlock(&all->lock);
    return slowest != NULL;
}

hn_connection_watch *hn_connections_add(hn_connections *all, int fd, hn_client client) {
    hn_connection_watch *w = calloc(1, sizeof *w);
    if (w) {
        w->fd = fd;
        w->client = client;
        w->since = hn_clock_wall();
        w->deadline = w->since + all->opts->head_deadline;
        pthread_mutex_lock(&all->lock);
        w->has_place = hn_shares_take(all->places, client);
        w->next = all->first;
        if (w->next) {
            w->next->before = w;
        }
        all->first = w;
        pthread_mutex_unlock(&all->lock);
    }
    return w;
}

void hn_connections_remove(hn_connections *all, hn_connection_watch *w) {
    if (!w) {
        return;
    }
    pthread_mutex_lock(&all->lock);
    *(w->before ? &w->before->next : &all->first) = w->next;
    if (w->next) {
        w->next->before = w->before;
    }
    if (w->has_place) {
        hn_shares_give(all->places, w->client);
    }
    pthread_mutex_unlock(&all->lock);
    free(w);
}

/// Finds what the connection does from now on, and for how long it may [s]. Returns false where it
/// has been ended.
static bool set_state(hn_connections *all, hn_connection_watch *w, connection_state state,
                      double seconds) {
    bool goes_on = true;
    if (w) {
        pthread_mutex_lock(&all->lock);
        goes_on = !w->has_ended;
        w->state = state;
        w->since = hn_clock_wall();
        w->deadline = goes_on ? w->since + seconds : HUGE_VAL;
        w->n_read = bytes_read(w->fd);
        pthread_mutex_unlock(&all->lock);
    }
    return goes_on;
}

void hn_connection_reads_body(hn_connections *all, hn_connection_watch *w) {
    set_state(all, w, STATE_IDLE, all->opts->request_deadline);
}

bool hn_connection_is_served(hn_connections *all, hn_connection_watch *w) {
    return set_state(all, w, STATE_SERVED, HUGE_VAL);
}

void hn_connection_sends(hn_connections *all, hn_connection_watch *w) {
    set_state(all, w, STATE_SENDS, HUGE_VAL);
}

void hn_connection_is_idle(hn_connections *all, hn_connection_watch *w) {
    hn_connection_is_answered(all, w);
    set_state(all, w, STATE_IDLE, all->opts->request_deadline);
}

void hn_connection_asks(hn_connections *all, hn_connection_watch *w) {
    if (w) {
        pthread_mutex_lock(&all->lock);
        w->asks = true;
        w->last = hn_clock_wall();
        w->deadline = fmin(w->deadline, w->last + all->opts->head_deadline);
        pthread_mutex_unlock(&all->lock);
    }
}

void hn_connection_goes_on(hn_connections *all, hn_connection_watch *w) {
    if (w) {
        pthread_mutex_lock(&all->lock);
        w->last = hn_clock_wall();
        pthread_mutex_unlock(&all->lock);
    }
}

void hn_connection_is_answered(hn_connections *all, hn_connection_watch *w) {
    if (w) {
        pthread_mutex_lock(&all->lock);
        w->asks = false;
        pthread_mutex_unlock(&all->lock);
    }
}
