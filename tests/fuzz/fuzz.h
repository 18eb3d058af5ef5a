// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FUZZ_H
#define HN_FUZZ_H
// The parts that the harnesses share. A harness calls what a person, a file or a request reaches,
// and ends the process where the program breaks a promise; sanitisers watch the rest.

#include "base/diag.h"
#include "base/strbuf.h"
#include "session/model/library.h"

#include <stdint.h>

/// The entry that libFuzzer calls.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/// Says what is wrong and ends the process.
void hn_fuzz_fail(const char *format, ...) HN_PRINTF(1, 2) __attribute__((noreturn));
/// A copy of the bytes with a zero behind; freed by the caller.
char *hn_fuzz_text(const uint8_t *data, size_t size);
/// Fails unless the text is one JSON value: no NaN, no Infinity. Then frees it.
void hn_fuzz_take_json(hn_strbuf *b);
/// Fails for a status that no input may lead to.
void hn_fuzz_check(hn_status status, const hn_diags *diags);
/// The shipped files, opened once.
const hn_library *hn_fuzz_library(void);
/// A folder of this process, empty at first, removed at its end.
const char *hn_fuzz_folder(void);
/// Writes a file.
void hn_fuzz_write(const char *path, const void *bytes, size_t n);

#endif
