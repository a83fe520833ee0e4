# nginx with docker/nginx.conf, for docker/compose.yaml. Not as root: it listens above 1024 and writes to /work alone.
ARG DEBIAN=debian:13.7-slim
FROM ${DEBIAN}
RUN apt-get update && apt-get install -y --no-install-recommends nginx-light \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt /var/log/*
COPY docker/nginx.conf /etc/papilio/nginx.conf
COPY docker/nginx /etc/papilio/nginx
RUN mkdir /work && chown 10001:10001 /work
USER 10001:10001
EXPOSE 8000
STOPSIGNAL SIGQUIT
ENTRYPOINT ["nginx", "-p", "/work", "-c", "/etc/papilio/nginx.conf"]
LABEL org.opencontainers.image.title="papilio-proxy" org.opencontainers.image.licenses="Apache-2.0"
