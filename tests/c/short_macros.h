/* short_macros.h - short names that a planner defines for itself. Some are words of this library's manuals. */
#define K 3
#define D 4
#define Kx 5
#define Pos (1 + 1)
#define Tip 7
#define Fault 8
#define GetTip(Finger) (Tip + (Finger))
