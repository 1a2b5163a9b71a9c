/* The functions of math.h that CORE-MATH calls by name: instructions of WebAssembly, and what Rust's own runtime provides. */
#ifndef ANTUMBRA_MATH_H
#define ANTUMBRA_MATH_H

#define NAN __builtin_nanf("")
#define INFINITY __builtin_inff()
#define HUGE_VAL __builtin_inf()
#define isnan(x) __builtin_isnan(x)
#define isinf(x) __builtin_isinf(x)
#define signbit(x) __builtin_signbit(x)

double sqrt(double);
double floor(double);
double trunc(double);
double copysign(double, double);
double fabs(double);
double fma(double, double, double);

/* Of lgamma, which nothing here calls. */
extern int signgam;

#endif
