/* CORE-MATH prints where a worst case turns up that its authors have proved away; then it calls exit. */
#ifndef ANTUMBRA_STDIO_H
#define ANTUMBRA_STDIO_H

#define printf(...) ((void)0)
#define fprintf(...) ((void)0)

#endif
