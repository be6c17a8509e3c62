// The function of bcryptprimitives.dll that Rust's standard library requires. Windows has it since version 10, Debian's Wine 8 lacks it.
#include <windows.h>

// Exported name of RtlGenRandom in advapi32.dll.
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
