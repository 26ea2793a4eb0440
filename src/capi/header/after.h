#ifdef __cplusplus
}
#endif


/* The rest of this file chooses between float and double (chapter 4). */

#if defined(SUN2XP_REAL)

#ifdef SUN2XP_REAL_DOUBLE
#define SendPos SendPosD
#define SendKx SendKxD
#define GetPos GetPosD
#endif

#elif defined(__cplusplus)

/* SendPos, SendKx and GetPos are templates, because NULL and 0 would match two overloads for pointers. NULL and 0 match
   no template, so the compiler calls the plain function, which refuses them. The block is extern "C++", because a
   planner may include this header inside its own extern "C". */
extern "C++" {

inline int Sun2XpSendPos(int Sun2XpFinger, const float *Sun2XpArray) { return ::SendPos(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpSendPos(int Sun2XpFinger, const double *Sun2XpArray) { return ::SendPosD(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpSendKx(int Sun2XpFinger, const float *Sun2XpArray) { return ::SendKx(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpSendKx(int Sun2XpFinger, const double *Sun2XpArray) { return ::SendKxD(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpGetPos(int Sun2XpFinger, float *Sun2XpArray) { return ::GetPos(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpGetPos(int Sun2XpFinger, double *Sun2XpArray) { return ::GetPosD(Sun2XpFinger, Sun2XpArray); }

template <class Sun2XpElement> inline int SendPos(int Sun2XpFinger, Sun2XpElement *Sun2XpArray)
{
    return Sun2XpSendPos(Sun2XpFinger, Sun2XpArray);
}

template <class Sun2XpElement> inline int SendKx(int Sun2XpFinger, Sun2XpElement *Sun2XpArray)
{
    return Sun2XpSendKx(Sun2XpFinger, Sun2XpArray);
}

template <class Sun2XpElement> inline int SendKx(int Sun2XpFinger, Sun2XpElement (*Sun2XpArray)[3])
{
    return Sun2XpSendKx(Sun2XpFinger, reinterpret_cast<Sun2XpElement *>(Sun2XpArray));
}

template <class Sun2XpElement> inline int GetPos(int Sun2XpFinger, Sun2XpElement *Sun2XpArray)
{
    return Sun2XpGetPos(Sun2XpFinger, Sun2XpArray);
}

}

#else

/* SUN2XP_NO_GENERIC disables _Generic, for compilers that claim to support it but do not. */
#if defined(SUN2XP_NO_GENERIC)
#elif defined(__clang__)
#if __has_extension(c_generic_selections)
#define SUN2XP_GENERIC __extension__ _Generic
#endif
#elif defined(__GNUC__)
#if __GNUC__ > 4 || (__GNUC__ == 4 && __GNUC_MINOR__ >= 9)
#define SUN2XP_GENERIC __extension__ _Generic
#endif
#elif defined(__STDC_VERSION__)
#if __STDC_VERSION__ >= 201112L
#define SUN2XP_GENERIC _Generic
#endif
#endif

/* The macros below use these names, because a planner may have macros named like C keywords. */
typedef char Sun2XpChar;
typedef int Sun2XpInt;
typedef long Sun2XpLong;
typedef void Sun2XpVoid;
typedef const void Sun2XpVoidC;
typedef float Sun2XpFloat;
typedef const float Sun2XpFloatC;
typedef volatile float Sun2XpFloatV;
typedef const volatile float Sun2XpFloatCV;
typedef double Sun2XpDouble;
typedef const double Sun2XpDoubleC;
typedef volatile double Sun2XpDoubleV;
typedef const volatile double Sun2XpDoubleCV;

#ifdef SUN2XP_GENERIC
/* SUN2XP_TYPED converts NULL and 0 to a pointer to this type. They compile, and are refused at run time. The type is
   incomplete, so no variable of a planner can have it. */
typedef struct Sun2XpNull Sun2XpNull;
/* A conditional expression with the branch (Sun2XpNull *)0 has the type Sun2XpNull * only if its other branch is a null
   pointer constant. So void * pointers and integers other than 0 become void *, which matches no association of
   SUN2XP_SEND and SUN2XP_GET. */
#define SUN2XP_NULL_POINTER(Array) \
    (1 ? _Generic(Array, Sun2XpVoid *: Array, default: (Sun2XpVoid *)0) : (Sun2XpNull *)0)
#define SUN2XP_NULL_NUMBER(Array) \
    (1 ? (Sun2XpVoid *)(Sun2XpLong)_Generic(Array, Sun2XpInt: Array, Sun2XpLong: Array, default: 0) : (Sun2XpNull *)0)
/* A pointer to an array of variable length matches both Element (*)[3] and Element (*)[9], so one _Generic must not
   list both. */
#define SUN2XP_ROWS_OF_9(Element) \
    Element (*)[9]: (Element *)0, Element##C (*)[9]: (Element##C *)0, \
    Element##V (*)[9]: (Element##V *)0, Element##CV (*)[9]: (Element##CV *)0
#define SUN2XP_TYPED(Array) \
    _Generic(Array, SUN2XP_ROWS_OF_9(Sun2XpFloat), SUN2XP_ROWS_OF_9(Sun2XpDouble), \
        Sun2XpVoid *: SUN2XP_NULL_POINTER(Array), \
        Sun2XpInt: SUN2XP_NULL_NUMBER(Array), Sun2XpLong: SUN2XP_NULL_NUMBER(Array), default: Array)
#define SUN2XP_POINTERS(Element, Call) Element *: Call, Element (*)[3]: Call, Element (*)[3][3]: Call
#define SUN2XP_SEND(Single, Double, Finger, Array) \
    (SUN2XP_GENERIC(SUN2XP_TYPED(Array), \
        SUN2XP_POINTERS(Sun2XpFloat, Single), SUN2XP_POINTERS(Sun2XpFloatC, Single), \
        SUN2XP_POINTERS(Sun2XpFloatV, Single), SUN2XP_POINTERS(Sun2XpFloatCV, Single), \
        SUN2XP_POINTERS(Sun2XpDouble, Double), SUN2XP_POINTERS(Sun2XpDoubleC, Double), \
        SUN2XP_POINTERS(Sun2XpDoubleV, Double), SUN2XP_POINTERS(Sun2XpDoubleCV, Double), \
        Sun2XpNull *: Single)((Finger), (Sun2XpVoidC *)Array))
#define SUN2XP_GET(Single, Double, Finger, Array) \
    (SUN2XP_GENERIC(SUN2XP_TYPED(Array), \
        SUN2XP_POINTERS(Sun2XpFloat, Single), SUN2XP_POINTERS(Sun2XpFloatV, Single), \
        SUN2XP_POINTERS(Sun2XpDouble, Double), SUN2XP_POINTERS(Sun2XpDoubleV, Double), \
        Sun2XpNull *: Single)((Finger), (Sun2XpVoid *)Array))
#else
/* float, float[3], float[9] have 4, 12, 36 bytes; double, double[3], double[9] have 8, 24, 72. If the size is not a
   multiple of the size of a float (some compilers give void the size 1), the type char[-1] does not compile. */
#define SUN2XP_IS_FLOAT(Array) \
    (sizeof *Array % sizeof(Sun2XpDouble) + 0 * sizeof(Sun2XpChar[sizeof *Array % sizeof(Sun2XpFloat) ? -1 : 1]))
#define SUN2XP_SEND(Single, Double, Finger, Array) \
    (SUN2XP_IS_FLOAT(Array) ? Single((Finger), (Sun2XpVoidC *)Array) : Double((Finger), (Sun2XpVoidC *)Array))
#define SUN2XP_GET(Single, Double, Finger, Array) \
    (SUN2XP_IS_FLOAT(Array) ? Single((Finger), (Sun2XpVoid *)Array) : Double((Finger), (Sun2XpVoid *)Array))
#endif

/* From C99 on the array may be a compound literal. Its commas separate macro arguments, so the macros are variadic. */
#if defined(__STDC_VERSION__) && __STDC_VERSION__ >= 199901L
#define SendPos(Finger, ...) SUN2XP_SEND(SendPos, SendPosD, Finger, (__VA_ARGS__))
#define SendKx(Finger, ...) SUN2XP_SEND(SendKx, SendKxD, Finger, (__VA_ARGS__))
#define GetPos(Finger, ...) SUN2XP_GET(GetPos, GetPosD, Finger, (__VA_ARGS__))
#else
#define SendPos(Finger, Pos) SUN2XP_SEND(SendPos, SendPosD, Finger, (Pos))
#define SendKx(Finger, Kx) SUN2XP_SEND(SendKx, SendKxD, Finger, (Kx))
#define GetPos(Finger, Pos) SUN2XP_GET(GetPos, GetPosD, Finger, (Pos))
#endif

#endif

@UNSHIELD@
#endif
