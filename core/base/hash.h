// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_HASH_H
#define HN_BASE_HASH_H
// A 64-bit hash (FNV-1a with a final mix) for ids and interning. Not for secrets.

#include <stddef.h>
#include <stdint.h>

#define HN_HASH_START 0xcbf29ce484222325ull

/// Continue a hash, which begins with HN_HASH_START, with n bytes or with a text.
uint64_t hn_hash_bytes(uint64_t hash, const void *bytes, size_t n);
uint64_t hn_hash_text(uint64_t hash, const char *text);
/// Continues with a word at once, for tables in memory: an eighth of the work of its bytes.
static inline uint64_t hn_hash_word(uint64_t hash, uint64_t word) {
    return (hash ^ word) * 0x9e3779b97f4a7c15ull + (hash >> 29);
}
uint64_t hn_hash_double(uint64_t hash, double value); ///< -0 and 0 hash alike
/// The last step: spreads a change of any bit over all of them.
uint64_t hn_hash_mix(uint64_t hash);
/// 16 lower-case hex digits and a zero.
void hn_hash_hex(uint64_t hash, char out[17]);
#endif
