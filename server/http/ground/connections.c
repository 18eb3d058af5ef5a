// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/connections.h"

#include "base/clock.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>

enum { LOOK_MS = 250 };

struct hn_connection_watch {
    int fd;
    hn_client client;
    bool has_place;  ///< it is counted
    double deadline; ///< [s, wall clock]
    hn_connection_watch *next, *before;
};

struct hn_connections {
    pthread_mutex_t lock;
    pthread_cond_t ending;
    const hn_http_opts *opts;
    hn_connection_watch *first;
    hn_shares *places;
    pthread_t thread;
    int has_thread, stop;
};

/// Ends what is beyond its deadline: the library then finds the connection closed. With the lock
/// held.
static void look(hn_connections *all) {
    const double now = hn_clock_wall();
    for (hn_connection_watch *w = all->first; w; w = w->next) {
        if (now > w->deadline) {
            shutdown(w->fd, SHUT_RDWR);
            w->deadline = HUGE_VAL;
        }
    }
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
    free(all);
}

bool hn_connections_may_add(hn_connections *all, hn_client client) {
    return hn_shares_has_place(all->places, client);
}

hn_connection_watch *hn_connections_add(hn_connections *all, int fd, hn_client client) {
    hn_connection_watch *w = calloc(1, sizeof *w);
    if (w) {
        w->fd = fd;
        w->client = client;
        w->has_place = hn_shares_take(all->places, client);
        w->deadline = hn_clock_wall() + all->opts->head_deadline;
        pthread_mutex_lock(&all->lock);
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
    pthread_mutex_unlock(&all->lock);
    if (w->has_place) {
        hn_shares_give(all->places, w->client);
    }
    free(w);
}

static void set_deadline(hn_connections *all, hn_connection_watch *w, double seconds) {
    if (w) {
        pthread_mutex_lock(&all->lock);
        w->deadline = hn_clock_wall() + seconds;
        pthread_mutex_unlock(&all->lock);
    }
}

void hn_connection_reads_body(hn_connections *all, hn_connection_watch *w) {
    set_deadline(all, w, all->opts->request_deadline);
}

void hn_connection_is_served(hn_connections *all, hn_connection_watch *w) {
    set_deadline(all, w, HUGE_VAL);
}

void hn_connection_is_idle(hn_connections *all, hn_connection_watch *w) {
    set_deadline(all, w, all->opts->request_deadline);
}
