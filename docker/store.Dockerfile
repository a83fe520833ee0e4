# Redis (Debian's: valkey or redis) as the shared store of meshes, for docker/compose.yaml. What is acknowledged is on
# disk: an append-only file in /data, synced before it is acknowledged.
ARG DEBIAN=debian:13.7-slim
FROM ${DEBIAN}
RUN apt-get update && apt-get install -y --no-install-recommends redis-server redis-tools \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt /var/log/* \
 && mkdir /data && chown 10001:10001 /data
USER 10001:10001
WORKDIR /data
VOLUME /data
EXPOSE 6379
HEALTHCHECK --interval=10s --timeout=3s CMD ["redis-cli", "ping"]
ENTRYPOINT ["redis-server", "--dir", "/data", "--appendonly", "yes", "--appendfsync", "always", "--protected-mode", "no", "--save", ""]
LABEL org.opencontainers.image.title="papilio-store" org.opencontainers.image.licenses="Apache-2.0"
