/* Integers; no formats are printed. */
#ifndef ANTUMBRA_INTTYPES_H
#define ANTUMBRA_INTTYPES_H

#include <stdint.h>
#define PRIx64 "llx"
#define PRIu64 "llu"
#define PRId64 "lld"

#endif
