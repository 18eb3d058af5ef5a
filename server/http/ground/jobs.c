// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/jobs.h"

#include <pthread.h>

struct hn_jobs {
    pthread_mutex_t lock;
    pthread_cond_t more;
    void (*run)(void *job);
    void **queue; ///< ring
    int cap, n, head, stopping;
    int n_threads;
    pthread_t *threads;
};

static void *work(void *arg) {
    hn_jobs *jobs = arg;
    pthread_mutex_lock(&jobs->lock);
    for (;;) {
        while (jobs->n == 0 && !jobs->stopping) {
            pthread_cond_wait(&jobs->more, &jobs->lock);
        }
        if (jobs->n == 0) {
            break;
        }
        void *job = jobs->queue[jobs->head];
        jobs->head = (jobs->head + 1) % jobs->cap;
        jobs->n--;
        pthread_mutex_unlock(&jobs->lock);
        jobs->run(job);
        pthread_mutex_lock(&jobs->lock);
    }
    pthread_mutex_unlock(&jobs->lock);
    return NULL;
}

hn_jobs *hn_jobs_create(int n_threads, int n_waiting, void (*run)(void *job)) {
    hn_jobs *jobs = calloc(1, sizeof *jobs);
    if (!jobs) {
        return NULL;
    }
    pthread_mutex_init(&jobs->lock, NULL);
    pthread_cond_init(&jobs->more, NULL);
    jobs->run = run;
    jobs->cap = n_waiting;
    jobs->queue = calloc((size_t)n_waiting, sizeof *jobs->queue);
    jobs->threads = calloc((size_t)n_threads, sizeof *jobs->threads);
    while (jobs->queue && jobs->threads && jobs->n_threads < n_threads &&
           pthread_create(&jobs->threads[jobs->n_threads], NULL, work, jobs) == 0) {
        jobs->n_threads++;
    }
    if (jobs->n_threads < n_threads) {
        hn_jobs_free(jobs);
        return NULL;
    }
    return jobs;
}

int hn_jobs_push(hn_jobs *jobs, void *job) {
    pthread_mutex_lock(&jobs->lock);
    int taken = !jobs->stopping && jobs->n < jobs->cap;
    if (taken) {
        jobs->queue[(jobs->head + jobs->n++) % jobs->cap] = job;
        pthread_cond_signal(&jobs->more);
    }
    pthread_mutex_unlock(&jobs->lock);
    return taken;
}

void hn_jobs_stop(hn_jobs *jobs) {
    pthread_mutex_lock(&jobs->lock);
    jobs->stopping = 1;
    pthread_cond_broadcast(&jobs->more);
    pthread_mutex_unlock(&jobs->lock);
    for (int i = 0; i < jobs->n_threads; i++) {
        pthread_join(jobs->threads[i], NULL);
    }
    jobs->n_threads = 0;
}

void hn_jobs_free(hn_jobs *jobs) {
    if (jobs) {
        hn_jobs_stop(jobs);
        pthread_cond_destroy(&jobs->more);
        pthread_mutex_destroy(&jobs->lock);
        free(jobs->queue);
        free(jobs->threads);
        free(jobs);
    }
}
