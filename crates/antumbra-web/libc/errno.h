/* Nobody reads errno here. */
#ifndef ANTUMBRA_ERRNO_H
#define ANTUMBRA_ERRNO_H

#define EDOM 33
#define ERANGE 34
static int errno __attribute__((unused));

#endif
