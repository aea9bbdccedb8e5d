#include "base/system/exceptions.h"
#include <exception>

extern "C" void ffd_exceptions_prepare(void)
{
    (void)std::current_exception();
}
