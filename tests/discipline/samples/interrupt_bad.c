/* A vector table one of whose handlers reaches floating point, and one a pointer. */
typedef void (*vector_t)(void);

extern unsigned stack_top;
volatile float level;
volatile vector_t called;

void reset_handler(void);
void quiet_handler(void);
void floating_handler(void);
void pointing_handler(void);

__attribute__((noinline)) static void scale(void) /* BAD: floating point in an interrupt */
{
    level = level * 0.5f;
}

void reset_handler(void) /* may: it is no interrupt */
{
    level = level + 1.0f;
}

void quiet_handler(void)
{
    called = quiet_handler;
}

void floating_handler(void)
{
    scale();
    quiet_handler();
}

void pointing_handler(void) /* BAD: indirect call in an interrupt */
{
    called();
}

unsigned stack_top;

__attribute__((section(".vectors"), used)) static const struct {
    unsigned *stack;
    vector_t handler[4];
} vectors = {&stack_top, {reset_handler, quiet_handler, floating_handler, pointing_handler}};
