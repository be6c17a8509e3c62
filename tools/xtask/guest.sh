#!/bin/busybox sh
# Init process of the virtual machine in which `cargo xtask kernel` runs its tests.
/bin/busybox --install -s /bin
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mount -t tmpfs none /tmp
# SDL finds sticks in this folder and watches it for new ones, because there is no udev.
mkdir -p /dev/input
export SDL_JOYSTICK_DISABLE_UDEV=1
for module in /modules/*; do
    [ -e "$module" ] && insmod "$module"
done
/test --ignored --test-threads=1 --show-output
# xtask reads the exit status from the file behind the second serial port.
echo $? >/dev/ttyS1
poweroff -f
