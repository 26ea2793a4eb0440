/* x11_macros.h - macros of X11/X.h and X11/Xlib.h that are ordinary words, and some macros of other old headers. A
   planner with a window includes them before this library's header. */
#define Bool int
#define Status int
#define True 1
#define False 0
#define None 0L
#define Success 0
#define Always 2
#define Above 0
#define Below 1
#define Complex 0
#define Convex 2
#define Expose 12
#define KeyPress 2
#define FocusIn 9
#define FocusOut 10
#define CurrentTime 0L
#define GrayScale 1
#define Unsorted 0
#define ParentRelative 1L
#define QueuedAlready 0
#define AllTemporary 0L
#define Nonconvex 1
#define BadValue 2
#define AnyKey 0L
#define near
#define far
#define min(a, b) ((a) < (b) ? (a) : (b))
#define max(a, b) ((a) > (b) ? (a) : (b))
#define Abs(x) ((x) < 0 ? -(x) : (x))
#define i 1
#define Size 3
#define PI 3.14159265358979
