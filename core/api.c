/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "penumbra.h"

uint32_t pnb_api_version(void) {
    return PNB_API_VERSION;
}

const char *pnb_version(void) {
    return PNB_VERSION;
}

const char *pnb_result_name(pnb_result result) {
    switch (result) {
#define CASE(name)                                                                                                     \
    case name:                                                                                                         \
        return #name
        CASE(PNB_OK);
        CASE(PNB_TIMEOUT);
        CASE(PNB_ERROR_INVALID_ARGUMENT);
        CASE(PNB_ERROR_NO_BACKEND);
        CASE(PNB_ERROR_UNSUPPORTED);
        CASE(PNB_ERROR_OUT_OF_MEMORY);
        CASE(PNB_ERROR_CANCELLED);
        CASE(PNB_ERROR_CONTEXT_LOST);
        CASE(PNB_ERROR_FORKED);
        CASE(PNB_ERROR_FILE);
        CASE(PNB_ERROR_INTERNAL);
#undef CASE
    }
    return "unknown";
}
