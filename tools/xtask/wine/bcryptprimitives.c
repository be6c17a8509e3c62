// The one function of bcryptprimitives.dll that Rust's standard library asks for. Every Windows since 10 has it, and Debian's wine 8 has not.
#include <windows.h>

// RtlGenRandom, as advapi32.dll calls it.
BOOLEAN NTAPI SystemFunction036(PVOID bytes, ULONG count);

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE bytes, SIZE_T count)
{
    while (count > 0) {
        ULONG part = count > 0x10000000 ? 0x10000000 : (ULONG)count;
        if (!SystemFunction036(bytes, part))
            return FALSE;
        bytes += part;
        count -= part;
    }
    return TRUE;
}
