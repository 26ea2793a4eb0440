# Builds and installs the C library, the tool, the manual pages and the shell completions.
#
#   make                     builds them in target/dist, with cargo
#   make install             installs what was built, below /usr/local
#   make remote              builds the server and the library of remote hands in target/dist
#   make install-remote      installs them too, after make install
#   make uninstall           removes exactly the files that were installed
#   make deb                 builds a Debian package, target/dist/sun2xp_VERSION_ARCHITECTURE.deb
#   make wheel               builds the Python wheel in target/wheels; the same source gives the same bytes
#   make check-installed     installs into an empty folder, and uses the result with every compiler and build system
#   make clean               removes the folder target/dist
#
# Variables: prefix (default /usr/local), exec_prefix, bindir, libdir, includedir, datarootdir, mandir, docdir, DESTDIR;
# CARGOFLAGS for cargo, such as --offline. `make install` does not build, so that root needs no cargo.

prefix ?= /usr/local
exec_prefix ?= $(prefix)
bindir ?= $(exec_prefix)/bin
libdir ?= $(exec_prefix)/lib
includedir ?= $(prefix)/include
datarootdir ?= $(prefix)/share
mandir ?= $(datarootdir)/man
docdir ?= $(datarootdir)/doc/sun2xp
export prefix bindir libdir includedir datarootdir mandir docdir DESTDIR

TARGET := $(or $(CARGO_TARGET_DIR),target)
export BUILT := $(TARGET)/dist

all:
	packaging/build --target-dir "$(TARGET)" $(CARGOFLAGS)

install:
	packaging/install

remote:
	packaging/build-remote --target-dir "$(TARGET)" $(CARGOFLAGS)

install-remote:
	packaging/install-remote

uninstall:
	packaging/uninstall

deb: all
	packaging/deb

wheel:
	packaging/wheel "$(TARGET)/wheels"

check-installed: all
	packaging/check-installed

clean:
	rm -rf "$(BUILT)"

.PHONY: all install remote install-remote uninstall deb wheel check-installed clean
