#ifndef HN_SESSION_ACCOUNT_DOC_H
#define HN_SESSION_ACCOUNT_DOC_H
// Where errors and energy come from, for several methods of one scene: the document of study/account.h.

#include "session/model.h"

typedef struct hn_accounts_request {
    const char *const *methods; ///< spellings; NULL: the scene's
    int n_methods;
    double time;             ///< [s]; NaN: the scene's duration
    int (*stop)(void *user); ///< asked now and then; NULL: never
    void (*progress)(void *user, double share);
    void *user;
} hn_accounts_request;

/// {"scene","time","methods":[{"method","state","reason","t","steps","error":{"coordinate","unit","value","sum","parts":{cause: number or
/// null}} or null,"energy":{"change","swing","conservative","loops_back_and_forth","parts":{item: number}}}...]}, energies in J. A method that cannot be
/// accounted for stands there with its reason. Fails: HN_ERR_INPUT for a spelling or a time; HN_ERR_BUDGET: stopped, what is done is in `b`.
HN_MUST_CHECK hn_status hn_accounts_json(hn_strbuf *b, const hn_model *model,
                                         const hn_accounts_request *request, hn_diags *diags);
#endif
