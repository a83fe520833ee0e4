# The suite on Debian 13, the Debian of the images: `./dev container suite` builds this, `programs` without the unit tests,
# and it fails when a test does. What set-up brings is a layer of its own, kept until set-up itself changes.
ARG DEBIAN=debian:13.7-slim
FROM ${DEBIAN}
WORKDIR /papilio
# What pages show is the same on each Debian.
ENV PAPILIO_TEST_PAGES=no
COPY dev ./
COPY tests/support tests/support
COPY client/web/package.json client/web/package-lock.json client/web/.npmrc client/web/
COPY tests/openapi/package.json tests/openapi/package-lock.json tests/openapi/.npmrc tests/openapi/
COPY tests/scenes/package.json tests/scenes/package-lock.json tests/scenes/.npmrc tests/scenes/
RUN tests/support/setup.sh build wasm test && tests/support/library_source.sh meshoptimizer libmeshoptimizer-dev
COPY . .
ARG PAPILIO_TEST_UNITS=yes
RUN --mount=type=cache,target=/root/.cache/ccache ./dev test
