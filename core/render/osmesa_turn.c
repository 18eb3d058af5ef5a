// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/osmesa_turn.h"

#include <pthread.h>
#include <time.h>

/// A thread that waits looks so often [ns].
enum { LOOK_EVERY = 2 * 1000 * 1000 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static bool is_taken; // under the lock, as the other two
static int n_waiting; // without those that ask: their interrupt may set them aside for long
static unsigned long long n_taken;

/// Sleeps for a moment as one that waits. With the lock held, which is given up meanwhile.
static void wait_a_moment(void) {
    n_waiting++;
    pthread_mutex_unlock(&lock);
    nanosleep(&(struct timespec){.tv_nsec = LOOK_EVERY}, NULL);
    pthread_mutex_lock(&lock);
    n_waiting--;
}

/// Asks without the lock. With the lock held.
static bool must_end(const hn_interrupt *interrupt) {
    pthread_mutex_unlock(&lock);
    const bool ends = hn_interrupt_ask(interrupt);
    pthread_mutex_lock(&lock);
    return ends;
}

/// Waits until nobody has the turn, and no other waits since `passed` turns were taken. With the
/// lock held.
static bool wait_for_turn(const hn_interrupt *interrupt, unsigned long long passed) {
    bool ends = must_end(interrupt);
    while (!ends && (is_taken || (n_waiting > 0 && n_taken == passed))) {
        wait_a_moment();
        ends = must_end(interrupt);
    }
    if (!ends) {
        is_taken = true;
        n_taken++;
    }
    return !ends;
}

bool hn_osmesa_turn_take(const hn_interrupt *interrupt) {
    pthread_mutex_lock(&lock);
    const bool taken = wait_for_turn(interrupt, n_taken - 1);
    pthread_mutex_unlock(&lock);
    return taken;
}

void hn_osmesa_turn_give(void) {
    pthread_mutex_lock(&lock);
    is_taken = false;
    pthread_mutex_unlock(&lock);
}

bool hn_osmesa_turn_pass(const hn_interrupt *interrupt) {
    pthread_mutex_lock(&lock);
    is_taken = false;
    const bool taken = wait_for_turn(interrupt, n_taken);
    pthread_mutex_unlock(&lock);
    return taken;
}
