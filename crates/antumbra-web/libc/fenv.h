/* The floating-point environment of WebAssembly: round to nearest, no flags. What CORE-MATH asks of it, as constants. */
#ifndef ANTUMBRA_FENV_H
#define ANTUMBRA_FENV_H

typedef int fenv_t;
typedef int fexcept_t;

#define FE_INVALID 1
#define FE_DIVBYZERO 2
#define FE_OVERFLOW 4
#define FE_UNDERFLOW 8
#define FE_INEXACT 16
#define FE_ALL_EXCEPT 31

#define FE_TONEAREST 0
#define FE_DOWNWARD 1
#define FE_UPWARD 2
#define FE_TOWARDZERO 3

static inline int fegetround(void) { return FE_TONEAREST; }
static inline int feraiseexcept(int flags) { (void)flags; return 0; }
static inline int feclearexcept(int flags) { (void)flags; return 0; }
static inline int fetestexcept(int flags) { (void)flags; return 0; }
static inline int fegetexceptflag(fexcept_t *to, int flags) { (void)flags; *to = 0; return 0; }
static inline int fesetexceptflag(const fexcept_t *from, int flags) { (void)from; (void)flags; return 0; }
static inline int feholdexcept(fenv_t *to) { *to = 0; return 0; }
static inline int feupdateenv(const fenv_t *from) { (void)from; return 0; }

#endif
