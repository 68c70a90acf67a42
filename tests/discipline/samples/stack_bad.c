/* Stack whose size is only known when it is taken. */
void stack_bad(unsigned count);
void use(unsigned char *bytes);

void stack_bad(unsigned count) /* BAD: stack without a bound */
{
    unsigned char bytes[count];
    use(bytes);
}
