// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_ALLOC_H
#define HN_SUPPORT_ALLOC_H
// Counts and fails the allocations of the code under test. Every unit test is linked with
// -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=free, so calls made by our own objects come
// here; calls made inside shared libraries (GSL, OSMesa, libc's own) do not.

/// Calls of malloc, calloc and realloc (to a size above 0) so far, failed ones included.
long hn_alloc_count(void);

/// The n-th call from now returns NULL, once; 0: none will. n = 1 is the next call.
void hn_alloc_fail_at(long n);

/// 1 if the failure asked for last has happened.
int hn_alloc_has_failed(void);

/// Pieces given out and not yet freed.
long hn_alloc_live(void);
#endif
