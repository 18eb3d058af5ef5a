// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/shipped_library.h"

hn_library *hn_test_library;

int hn_test_library_open(void **state) {
    (void)state;
    hn_diag diag = {0};
    return hn_library_open(".", &hn_test_library, &diag) != HN_OK;
}

int hn_test_library_close(void **state) {
    (void)state;
    hn_library_free(hn_test_library);
    hn_test_library = NULL;
    return 0;
}
